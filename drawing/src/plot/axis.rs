//! Logarithmic axes and their ticks.

/// The scale of an axis, and the notation of its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Decades: 0.01, 0.1, 1.
    Log,
    /// Numbers of bits b, which stand for `2^b`: a slope is taken over `2^b`.
    Bits,
}

/// An axis of a plot: its label and its scale.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotAxis {
    /// The label: the quantity that the axis measures.
    pub label: String,
    /// The map from values to places on the axis.
    pub scale: Scale,
}

impl PlotAxis {
    /// Creates an axis of decades.
    pub fn log(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            scale: Scale::Log,
        }
    }

    /// Creates an axis of bits.
    pub fn bits(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            scale: Scale::Bits,
        }
    }

    /// Returns the place of a value on this axis. `None` if the place is not finite.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let place = match self.scale {
            Scale::Log => libm::log10(value),
            Scale::Bits => value,
        };
        place.is_finite().then_some(place)
    }

    /// Returns the base-10 logarithm of the value at `place`, over which slopes are fitted.
    pub(super) fn logarithm(&self, place: f64) -> f64 {
        match self.scale {
            Scale::Log => place,
            Scale::Bits => place * std::f64::consts::LOG10_2,
        }
    }

    /// Returns the range of the axis for `places`: a little wider than theirs, and never empty.
    pub(super) fn range(&self, places: impl Iterator<Item = f64>) -> [f64; 2] {
        let ends = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| {
            [low.min(place), high.max(place)]
        });
        let [low, high] = if ends[0] > ends[1] { [0.0; 2] } else { ends };
        let least = match self.scale {
            Scale::Log => 0.6,
            Scale::Bits => 2.0,
        };
        let middle = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max(0.5 * least) * 1.06;
        [middle - half, middle + half]
    }

    /// Returns at most about `most` ticks within a range of places: (place, label) of each.
    pub(super) fn ticks(&self, [low, high]: [f64; 2], most: usize) -> Vec<(f64, String)> {
        match self.scale {
            Scale::Bits => (whole(low, high, most).into_iter())
                .map(|value| (value, value.to_string()))
                .collect(),
            Scale::Log => decades(low, high, most),
        }
    }
}

/// Returns the whole numbers of a range, with a step of 1, 2, 3, 4, 6, ...
fn whole(low: f64, high: f64, most: usize) -> Vec<f64> {
    let steps = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0];
    let fits = |step: &&f64| (((high - low) / **step) as usize) < most.max(2);
    let step = steps.iter().find(fits).copied().unwrap_or(32.0);
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first) as i64;
    (0..=count).map(|k| (first + k as f64) * step).collect()
}

fn decades(low: f64, high: f64, most: usize) -> Vec<(f64, String)> {
    let whole = whole(low, high, most);
    if whole.len() > 2 {
        let tick = |value| (value, written(1.0, value));
        return whole.into_iter().map(tick).collect();
    }
    let mut ticks = Vec::new();
    for decade in low.floor() as i64..=high.ceil() as i64 {
        for digit in [1.0, 2.0, 5.0] {
            let value = decade as f64 + libm::log10(digit);
            if (low..=high).contains(&value) {
                ticks.push((value, written(digit, decade as f64)));
            }
        }
    }
    ticks
}

/// Formats `digit 10^exponent`: as a decimal for exponents from -4 to 4, else as a power of ten.
fn written(digit: f64, exponent: f64) -> String {
    let exponent = exponent as i32;
    if (-4..=4).contains(&exponent) {
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        return format!("{:.decimals$}", digit * libm::exp10(f64::from(exponent)));
    }
    let power: String = exponent.to_string().chars().map(superscript).collect();
    if digit == 1.0 {
        format!("10{power}")
    } else {
        format!("{digit}\u{b7}10{power}")
    }
}

fn superscript(c: char) -> char {
    match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        _ => c
            .to_digit(10)
            .and_then(|d| char::from_u32(0x2070 + d))
            .unwrap_or(c),
    }
}
