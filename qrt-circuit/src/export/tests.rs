use super::*;
use crate::quantum::{Conjunction, PhaseOracle, Window};

fn text(counting: &CountingCircuit<'_>, part: CircuitPart, format: ExportFormat) -> String {
    let mut text = Vec::new();
    let export = Export::new(counting, part, &[]).unwrap();
    let tally = export.write(format, &[], &mut text).unwrap();
    assert_eq!(tally.bytes, text.len() as u64);
    String::from_utf8(text).unwrap()
}

fn gates(text: &str) -> Vec<&str> {
    let plain = |line: &&str| {
        let words = ["OPENQASM", "include", "//", "q", "bit", "creg"];
        !words.iter().any(|word| line.starts_with(word))
    };
    text.lines().filter(plain).collect()
}

#[test]
fn signs_under_one_two_and_three_qubits_have_gates() {
    let oracle = PhaseOracle::polynomial(3, vec![vec![1], vec![2, 0], vec![0, 1, 2]]).unwrap();
    let counting = CountingCircuit::new(&oracle, 1, Window::Rect).unwrap();
    let lines = [
        "z index[1];",
        "cz index[2], index[0];",
        "h index[2];",
        "ccx index[0], index[1], index[2];",
        "h index[2];",
    ];
    for format in [ExportFormat::OpenQasm3, ExportFormat::OpenQasm2] {
        assert_eq!(gates(&text(&counting, CircuitPart::Oracle, format)), lines);
    }
}

#[test]
fn a_counting_circuit_of_one_id_bit_is_known_line_by_line() {
    let oracle = PhaseOracle::polynomial(1, vec![vec![0]]).unwrap();
    let counting = CountingCircuit::with(&oracle, 2, Window::Rect, Conjunction::Toffolis).unwrap();
    let iterate = |control: u32| {
        [
            format!("cz phase_register[{control}], index[0];"),
            "h index[0];".to_owned(),
            "x index[0];".to_owned(),
            format!("cz phase_register[{control}], index[0];"),
            "x index[0];".to_owned(),
            format!("z phase_register[{control}];"),
            "h index[0];".to_owned(),
        ]
    };
    for (format, phase, measures) in [
        (
            ExportFormat::OpenQasm3,
            "cp",
            [
                "outcome[0] = measure phase_register[0];",
                "outcome[1] = measure phase_register[1];",
            ],
        ),
        (
            ExportFormat::OpenQasm2,
            "cu1",
            [
                "measure phase_register[0] -> outcome[0];",
                "measure phase_register[1] -> outcome[1];",
            ],
        ),
    ] {
        let mut lines = [
            "h phase_register[0];",
            "h phase_register[1];",
            "h index[0];",
        ]
        .map(str::to_owned)
        .to_vec();
        for control in [0, 1, 1] {
            lines.extend(iterate(control));
        }
        lines.extend([
            "cx phase_register[0], phase_register[1];".to_owned(),
            "cx phase_register[1], phase_register[0];".to_owned(),
            "cx phase_register[0], phase_register[1];".to_owned(),
            "h phase_register[0];".to_owned(),
            format!("{phase}(-1.5707963267948966) phase_register[0], phase_register[1];"),
            "h phase_register[1];".to_owned(),
        ]);
        lines.extend(measures.map(str::to_owned));
        assert_eq!(
            gates(&text(&counting, CircuitPart::Counting, format)),
            lines
        );
    }
}

#[test]
fn the_last_line_is_grammatical() {
    let tally = |gates: &[(&'static str, u64)], qubits| ExportCounts {
        by_name: gates.iter().copied().collect(),
        qubits,
        bytes: 0,
    };
    assert_eq!(tally(&[("z", 1)], 1).text(), "1 qubit, 1 gate: 1 z");
    assert_eq!(tally(&[], 2).text(), "2 qubits, 0 gates");
    assert_eq!(
        tally(&[("ccx", 1200), ("x", 7), ("cx", 1200)], 1234).text(),
        "1,234 qubits, 2,407 gates: 1,200 ccx, 1,200 cx, 7 x"
    );
}

#[test]
fn a_programs_registers_keep_their_names() {
    use crate::{Declaration, Machine, Recorder, Style, Type, Word};
    let mut m = Recorder::new(Style::InPlace);
    let of = |name| Declaration::work(name, Type::UInt, 2);
    let a = m.input(&of("ray1.x"));
    let b = m.input(&of("x"));
    let [a, b] = [&a, &b].map(|register| Word::unsigned(register, 0, 2));
    m.add(&of("ray1_x"), a.into(), b.into());
    let program = m.finish();
    let mut text = Vec::new();
    write_program(&program, &[], ExportFormat::OpenQasm3, &[], &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let declared: Vec<&str> = text
        .lines()
        .filter(|line| line.starts_with("qubit"))
        .collect();
    assert_eq!(
        declared,
        ["qubit[2] ray1_x;", "qubit[2] r_x;", "qubit[2] ray1_x_2;"]
    );
}

/// Words and gates of OpenQASM are also common names of registers.
#[test]
fn words_of_the_language_are_no_names_of_registers() {
    use crate::{Declaration, Recorder, Style, Type};
    let mut m = Recorder::new(Style::InPlace);
    for name in ["input", "bit", "swap", "inputs", "cos"] {
        m.input(&Declaration::work(name, Type::UInt, 2));
    }
    let program = m.finish();
    let mut text = Vec::new();
    write_program(&program, &[], ExportFormat::OpenQasm2, &[], &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let declared: Vec<&str> = text.lines().skip(2).take(5).collect();
    assert_eq!(
        declared,
        [
            "qreg r_input[2];",
            "qreg r_bit[2];",
            "qreg r_swap[2];",
            "qreg inputs[2];",
            "qreg r_cos[2];"
        ]
    );
}

#[test]
fn a_parameter_without_a_word_is_refused() {
    use crate::{Declaration, Machine, Parameter, Recorder, Style, Type};
    let parameter = Parameter {
        name: "word".to_owned(),
        width: 2,
    };
    let mut m = Recorder::with_registers(
        &[],
        vec![crate::Block::default()],
        vec![parameter],
        Style::InPlace,
    );
    m.load(&Declaration::work("t", Type::UInt, 2), 0);
    let program = m.finish();
    let write = |words: &[u64]| {
        let mut text = Vec::new();
        write_program(&program, words, ExportFormat::OpenQasm2, &[], &mut text)
            .map(|tally| tally.gates())
    };
    assert_eq!(write(&[0b10]).unwrap(), 1);
    assert!(matches!(
        write(&[]),
        Err(ExportError::MissingWord {
            parameter: 0,
            bit: 0
        })
    ));
}
