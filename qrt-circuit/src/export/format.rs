//! The two OpenQASM languages.

/// A language in which a circuit is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExportFormat {
    /// OpenQASM 3.0 (Cross et al., *OpenQASM 3: a broader and deeper quantum assembly language*,
    /// 2022), with its `stdgates.inc`.
    #[default]
    OpenQasm3,
    /// OpenQASM 2.0 (Cross et al., *Open quantum assembly language*, 2017), with its `qelib1.inc`.
    OpenQasm2,
}

impl ExportFormat {
    /// The language's name: `openqasm3` or `openqasm2`.
    pub fn name(self) -> &'static str {
        match self {
            Self::OpenQasm3 => "openqasm3",
            Self::OpenQasm2 => "openqasm2",
        }
    }

    /// Returns the first two lines of a text.
    pub(super) fn header(self) -> &'static str {
        match self {
            Self::OpenQasm3 => "OPENQASM 3.0;\ninclude \"stdgates.inc\";\n",
            Self::OpenQasm2 => "OPENQASM 2.0;\ninclude \"qelib1.inc\";\n",
        }
    }

    /// Returns the declaration of a register of qubits.
    pub(super) fn qubits(self, name: &str, qubits: usize) -> String {
        match self {
            Self::OpenQasm3 => format!("qubit[{qubits}] {name};\n"),
            Self::OpenQasm2 => format!("qreg {name}[{qubits}];\n"),
        }
    }

    /// Returns the declaration of a register of classical bits.
    pub(super) fn bits(self, name: &str, bits: usize) -> String {
        match self {
            Self::OpenQasm3 => format!("bit[{bits}] {name};\n"),
            Self::OpenQasm2 => format!("creg {name}[{bits}];\n"),
        }
    }

    /// Returns the statement that measures a qubit into a bit.
    pub(super) fn measure(self, qubit: &str, bit: &str) -> String {
        match self {
            Self::OpenQasm3 => format!("{bit} = measure {qubit};\n"),
            Self::OpenQasm2 => format!("measure {qubit} -> {bit};\n"),
        }
    }

    /// Returns the gate that multiplies by `exp(i angle)` where all of its one or two qubits are 1.
    pub(super) fn phase(self, qubits: usize) -> Option<&'static str> {
        match (self, qubits) {
            (Self::OpenQasm3, 1) => Some("p"),
            (Self::OpenQasm3, 2) => Some("cp"),
            (Self::OpenQasm2, 1) => Some("u1"),
            (Self::OpenQasm2, 2) => Some("cu1"),
            _ => None,
        }
    }
}

/// Names that a register cannot have in one of the languages, separated by spaces: the keywords,
/// and the functions, constants and gates of the libraries. Names of one letter are not listed.
const RESERVED: [&str; 4] = [
    "OPENQASM include defcalgrammar def cal defcal gate extern box let break continue if else end \
     return for while in switch case default nop pragma input output const readonly mutable qreg \
     qubit creg bool bit int uint float angle complex array void duration stretch gphase inv pow \
     ctrl negctrl dim durationof delay reset measure barrier true false opaque",
    "sizeof popcount rotl rotr mod ceiling floor real imag arccos arcsin arctan cos sin tan exp log \
     sqrt ln acos asin atan",
    "pi tau euler im",
    "id sx sdg tdg rx ry rz cx cy cz ch cp crx cry crz swap ccx cswap cu cu1 cu3 u1 u2 u3 phase \
     cphase rzz rxx",
];

/// True if a register may not have this name.
pub(super) fn is_reserved(name: &str) -> bool {
    let mut words = RESERVED.iter().flat_map(|words| words.split_whitespace());
    words.any(|word| word == name)
}
