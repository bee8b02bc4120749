//! Problems with expressions, and with the BSDFs that they define.

use super::{meant, rounded, shorten};
use std::fmt;

problems! {
    /// Problems with an expression's text.
    Expression {
        TooLong { bytes: usize, most: usize } = EXPR_SIZE
            "expression of {bytes} bytes; the limit is {most}";
        TooDeep { most: usize } = EXPR_SIZE "expression nested deeper than {most}";
        TooMany { minutes: u64, most: u64 } = EXPR_SIZE
            "checking the expressions of all BSDFs would take about {minutes} minutes; the limit is {most}"
            help "write fewer BSDFs, or shorter expressions; equal BSDFs are checked once";
        Empty = EXPR_EMPTY "the expression is empty";
        Unexpected { found: String } = EXPR_SYNTAX "unexpected `{found}`"
            help { Some(match found.as_str() {
                ")" => "there is no `(` for this `)`",
                "," => "a comma stands only between a function's operands",
                "=" => "write the value alone, without an equation",
                "**" => "a power is written with `^`",
                _ => "a product is written with `*`",
            }.to_owned()) };
        NoValue { found: Option<String> } = EXPR_SYNTAX
            { match found {
                Some(found) => format!("expected a value, found `{found}`"),
                None => "expected a value, found the end".to_owned(),
            } };
        NeverClosed = EXPR_SYNTAX "this `(` is never closed";
        NotClosed { found: String } = EXPR_SYNTAX "expected `)`, found `{found}`"
            help "a product is written with `*`";
        NoValueHere { name: String, allowed: Vec<&'static str> } = EXPR_VARIABLE
            "`{name}` has no value here"
            help { (!allowed.is_empty()).then(|| format!("this may depend on {}", allowed.join(", "))) };
        UnknownName { name: String, near: Option<&'static str>, allowed: Vec<&'static str> } = EXPR_NAME
            "unknown name `{name}`"
            help { Some(match (name.as_str(), near) {
                ("e", _) => "Euler's number is `exp(1)`".to_owned(),
                (_, Some(near)) => format!("did you mean `{near}`?"),
                (_, None) => format!("this may depend on {}, pi", allowed.join(", ")),
            }) };
        UnknownFunction { name: String, functions: Vec<&'static str> } = EXPR_NAME
            "unknown function `{name}`"
            help { match name.as_str() {
                "ln" => Some("the natural logarithm is `log`".to_owned()),
                _ => meant(name, functions)
                    .or_else(|| Some(format!("there are {}", functions.join(", ")))),
            } };
        NotAFunction { name: String } = EXPR_OPERANDS "`{name}` is not a function"
            help "a product is written with `*`";
        NoOperands { name: String, wanted: usize } = EXPR_OPERANDS
            "the function `{name}` has no operands"
            help { Some(match wanted {
                2 => format!("write `{name}(u, v)`"),
                4 => format!("write `{name}(a, b, x, y)`: x where a < b, y elsewhere"),
                _ => format!("write `{name}(u)`"),
            }) };
        Operands { name: String, wanted: usize, given: usize } = EXPR_OPERANDS
            { let s = if *wanted == 1 { "" } else { "s" };
              format!("`{name}` takes {wanted} operand{s}, not {given}") };
        TooLarge { text: String } = EXPR_NUMBER "`{text}` is too large";
        NotANumber { text: String } = EXPR_NUMBER "`{text}` is not a number";
    }

    /// Problems with the meaning of a BSDF's expressions. Pairs of numbers are points (u, v) of the
    /// unit square, except in `NotReciprocal`, which has (cos_i, cos_o).
    Bsdf {
        Channels { count: usize } = BSDF_CHANNELS
            "a BSDF has one value (grey) or three (RGB), not {count}";
        OffSphere { off: f64, at: [f64; 2] } = MAP_OFF_SPHERE
            { let length = match off {
                off if off.abs() < 1e-4 => format!("1 + {off:e}"),
                off => rounded(1.0 + off),
              };
              format!("the map leaves the unit sphere: its length is {length} at {}", point(*at)) }
            help "a direction has length 1: x^2 + y^2 + z^2 must be 1 for every u and v";
        NoDirection { at: [f64; 2] } = MAP_UNDEFINED
            { format!("this component of the map has no value at {}", point(*at)) }
            help "it must be finite for every u and v between 0 and 1";
        NoSlope { at: [f64; 2] } = MAP_UNDEFINED
            { format!("this component of the map has no finite slope at {}", point(*at)) }
            help "the Jacobian needs its derivatives between 0 and 1";
        Flat { around: [f64; 2] } = MAP_FLAT
            { format!("the map takes a whole area of the square to a line or a point, as around {}",
                point(*around)) }
            help "the direction must change with u and with v, along different ways";
        CoversTwice { around: [f64; 3], times: f64, whole: f64 } = MAP_COVERS_TWICE
            { covered(*around, *times, *whole) }
            help { Some(once()) };
        LeavesOut { around: [f64; 3], times: f64, whole: f64 } = MAP_LEAVES_OUT
            { covered(*around, *times, *whole) }
            help { Some(once()) };
        OnlyBelow = MAP_LEAVES_OUT
            "the map reaches directions below the surface alone: its third component is negative"
            help "the third component is the cosine to the normal: write `sqrt(1-u)` for `-sqrt(1-u)`";
        WrongJacobian { stated: f64, right: f64, at: [f64; 2], mistake: Mistake } = JACOBIAN_MISMATCH
            { format!("the stated Jacobian is {} at {}, but |dphi/du x dphi/dv| = {}",
                rounded(*stated), point(*at), rounded(*right)) } help "{mistake}";
        Negative { value: f64, at: Variables } = BSDF_NEGATIVE
            { format!("the value is negative: {} at {}", rounded(*value), situation(at)) }
            help "`max(0, ...)` cuts the negative part off";
        Undefined { is_infinite: bool, at: Variables } = BSDF_UNDEFINED
            { let what = if *is_infinite { "is infinite" } else { "has no value" };
              format!("the BSDF {what} at {}", situation(at)) }
            help "it must be finite for every pair of directions above the surface";
        UndefinedPart { part: Option<String>, is_infinite: bool, at: Variables } = BSDF_UNDEFINED
            { let part = part.as_ref().map_or_else(String::new, |part| format!(", `{}`,", shorten(part)));
              let what = if *is_infinite { "is infinite" } else { "has no value" };
              format!("a part of this{part} {what} at {}", situation(at)) }
            help "every part must be finite, also where the rest makes a finite number of it: no register \
                  holds an infinity";
        GainsEnergy { albedo: f64, at: Variables } = BSDF_ENERGY
            { let seen = match &at[..] {
                [] => String::new(),
                at => format!(", seen at {}", situation(at)),
              };
              format!("the BSDF gains energy: {} of the light that arrives leaves{seen}",
                rounded(*albedo)) }
            help { Some(format!(
                "the integral of value * |cos_i| over all directions must not pass 1: scale the value \
                 by {} or less", rounded(rounded_down(albedo.recip())))) };
        WrongPdf { stated: f64, right: f64, at: [f64; 2], mistake: Mistake } = PDF_MISMATCH
            { format!("the stated density is {} at {}, but 1 / |dphi/du x dphi/dv| = {}",
                rounded(*stated), point(*at), rounded(*right)) } help "{mistake}";
        PdfOfTheSquare = PDF_MISMATCH
            "a density is a function of directions: the value must not depend on u or v beside it"
            help "write the value in cos_i, cos_o, cos_a; or leave `pdf` out";
        PdfBeyondMap { whole: f64 } = PDF_MISMATCH
            { format!("the density integrates to {} over the hemisphere: the map leaves directions \
                out", rounded(*whole)) }
            help "let the map reach every direction, or leave `pdf` out";
        PdfBelow = PDF_MISMATCH "the map goes below the surface, where no lamp is sampled"
            help "leave `pdf` out";
        NotReciprocal { there: f64, back: f64, at: [f64; 2] } = NOT_RECIPROCAL
            { let [i, o] = at.map(rounded);
              format!("the value is {} at cos_i = {i}, cos_o = {o}, but {} with the two exchanged: \
                  light does not go this way as it goes the other", rounded(*there), rounded(*back)) }
            help "let cos_o enter as cos_i does, as in (1 + cos_i)*(1 + cos_o)";
        Unbounded = BSDF_UNBOUNDED "no bound of the weight value * |phi_z| * J can be shown"
            help "choose a map that sends more points where the value is large; a denominator that \
                  vanishes at grazing angles needs a small number more, as in 1/(cos_i + cos_o + 1e-3)";
    }
}

/// Variables of expressions with their values.
type Variables = Vec<(&'static str, f64)>;

/// The mistake in a stated Jacobian or density.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    Inverse,
    WithCosine,
    InverseWithCosine,
    Negative,
    Factor(f64),
    Other { right: String },
    Unlike,
    NotInverse,
    Density,
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inverse => {
                "this is 1/J: a change of variables multiplies by J, it does not divide"
            }
            Self::WithCosine => {
                "this is J |z|: the cosine is multiplied in already, J stands without it"
            }
            Self::InverseWithCosine => {
                "this is 1/(J |z|): write J, the solid angle per unit of the square"
            }
            Self::Negative => "this is -J: the Jacobian is a length, not a signed area",
            Self::Factor(factor) => return write!(f, "multiply it by {}", rounded(*factor)),
            Self::Other { right } => return write!(f, "write `{right}`, or `auto`"),
            Self::Unlike => "`jacobian: auto` works it out",
            Self::NotInverse => "this is the Jacobian: the density is 1 over it",
            Self::Density => {
                "write the density of directions per steradian, 1/J, in cos_i, cos_o and cos_a"
            }
        })
    }
}

fn point([u, v]: [f64; 2]) -> String {
    format!("u = {}, v = {}", rounded(u), rounded(v))
}

/// Rounds `number` down to four digits. A relative error of 1e-9 in it does not lower the result.
fn rounded_down(number: f64) -> f64 {
    let unit = 10_f64.powf(number.log10().floor() - 3.0);
    (number / unit * (1.0 + 1e-9)).floor() * unit
}

/// Describes how often a map covers directions.
fn covered(around: [f64; 3], times: f64, whole: f64) -> String {
    let [x, y, z] = around.map(|c| rounded((c * 100.0).round() / 100.0));
    let times = rounded((times * 10.0).round() / 10.0);
    let whole = rounded((whole * 100.0).round() / 100.0);
    format!(
        "the map covers the directions around [{x}, {y}, {z}] {times} times, and counts the \
         reflected light {whole} times on the whole"
    )
}

/// Returns the advice for a map that does not cover each direction once.
fn once() -> String {
    "let each direction that the value reflects to come from one point of the square, as with \
     sqrt(u)*cos(2*pi*v), sqrt(u)*sin(2*pi*v), sqrt(1-u)"
        .to_owned()
}

fn situation(variables: &[(&'static str, f64)]) -> String {
    let shown = variables.iter();
    let shown = shown.map(|(name, value)| format!("{name} = {}", rounded(*value)));
    shown.collect::<Vec<_>>().join(", ")
}
