//! A reversible routine, written by hand, on every machine: `cargo run --example reversible`.

use qrt::circuit::lower;
use qrt::prelude::*;

/// Adds approximately exp(x) to value: 1 + x + x^2 / 2 + x^3 / 6, by Horner's rule in fixed point.
#[reversible]
fn exponential(x: &Fixed<1, 12>, value: &mut Fixed<4, 12>) {
    let mut third: Fixed<3, 12> = 0;
    let mut second: Fixed<3, 12> = 0;
    within! {
        // 1365 / 4096 approximates 1/3.
        third += 1 + 0.333251953125 * x;
        second += 1 + wrapping(0.5 * third * x);
    }
    apply! {
        value += 1 + wrapping(second * x);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let program = exponential_program(Style::InPlace);
    let circuit = lower::circuit(&program);
    let toffoli: u64 = lower::tally(&program).iter().map(|cost| cost.toffoli).sum();
    println!(
        "{} qubits, {} gates, {} Toffolis",
        circuit.qubits,
        circuit.gates.len(),
        toffoli
    );

    let xs = [-1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75];
    let bits = xs.map(|x| Fixed::<1, 12>::bits(x).unwrap_or(0));
    let states = bits.map(|x| [x, 0]);
    let defined = run::on_definition(&program, &states)?;
    let fixed = run::on_fixed(&program, &states)?;
    let gates = run::on_gates(&program, &states)?;
    let back = run::on_gates(&program.inverse(), &gates)?;

    println!("    x    exp(x)  definition     fixed     gates  undone");
    for (lane, x) in xs.into_iter().enumerate() {
        let [d, f, g] = [&defined, &fixed, &gates].map(|run| Fixed::<4, 12>::value(run[lane][1]));
        let undone = back[lane] == states[lane];
        println!("{x:5} {:9.5} {d:11.5} {f:9.5} {g:9.5}  {undone}", x.exp());
    }
    Ok(())
}
