#[allow(dead_code, reason = "an author asks for some of them only")]
impl LitFloor {
    /// The most qubits in use at any time during a call of the oracle of the channel that
    /// has the most Toffolis.
    pub const QUBITS: u64 = 218;
    /// Toffoli gates of a call of the oracle of the channel that has the most.
    pub const TOFFOLI: u64 = 11070;
    /// A pixel has `2^PATH_BITS` paths.
    pub const PATH_BITS: u32 = 2;
    /// Qubits of the comparator.
    pub const COMPARATOR_BITS: u32 = 4;
    /// Bits after the point of every number.
    pub const FRACTION_BITS: u32 = 8;
    /// Rays on a path.
    pub const DEPTH: usize = 2;
    /// Columns and rows of the film.
    pub const FILM: [u32; 2] = [4, 4];
    /// By channel (red, green, blue): the proven bound on a path's colour, in radiance.
    pub const SCALE: [f64; 3] = [1.0, 1.0, 1.0];
    /// Operations from a path's id to its three colours.
    pub const OPERATIONS: usize = 49;
}

/// Numbers of the primary ray of [`LitFloor`] that are in registers.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LitFloorRay0 {
    /// Where it goes; the camera's are of no particular length.
    pub direction_y:
        ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UFixed<-3, 8>>,
    /// Where it goes; the camera's are of no particular length.
    pub direction_z:
        ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UFixed<-4, 8>>,
    /// How far away that is, in lengths of its direction.
    pub distance:
        ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UFixed<0, 8>>,
    /// The cell of the unit square that it samples.
    pub sample_u: ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UInt<1>>,
    /// The cell of the unit square that it samples.
    pub sample_v: ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UInt<1>>,
}

/// Numbers of ray 1 of [`LitFloor`] that are in registers.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LitFloorRay1 {
    /// Where it starts, in the scene's frame as the circuit scales it.
    pub origin: ::qrt::core::oracle::compiled::Vector<
        LitFloor,
        ::qrt::circuit::format::Fixed<-1, 8>,
        ::qrt::circuit::format::Fixed<0, 8>,
        ::qrt::circuit::format::Fixed<1, 8>,
    >,
    /// The cell of the unit square that it samples.
    pub sample_u: ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UInt<2>>,
    /// The cell of the unit square that it samples.
    pub sample_v: ::qrt::core::oracle::compiled::Field<LitFloor, ::qrt::circuit::format::UInt<2>>,
}

/// Where the numbers of a path of [`LitFloor`] are among its registers.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LitFloorLayout {
    /// Of the primary ray.
    pub ray0: LitFloorRay0,
    /// Of ray 1.
    pub ray1: LitFloorRay1,
}

#[allow(warnings, clippy::all, clippy::pedantic, reason = "written by `qrt!`")]
const _: () = {
    // A name that nothing of what is imported below has.
    type __Scene = LitFloor;
    const _: () = {
        use ::qrt::circuit::{
            Bit, BlockId, Declaration, Machine, Operand, RegisterId, Style, Tag, Type, Word,
        };
        use ::qrt::core::compile::{NamedPlace, PixelWord, Place};
        use ::qrt::core::oracle::Channel;
        use ::qrt::core::oracle::compiled::{
            BlockDeclaration, CompiledOracle, Computed, Field, Outline, Vector,
        };
        use ::qrt::core::tracer::Named;
        use ::qrt::runtime::machines::native::{Integers, NativeOracle, Truths, Vectors, word};
        impl __Scene {
            /// Where the numbers of a path are among its registers, ray by ray.
            pub const LAYOUT: LitFloorLayout = LitFloorLayout {
                ray0: LitFloorRay0 {
                    direction_y: Field::<__Scene, ::qrt::circuit::format::UFixed<-3, 8>>::new(
                        0,
                        Word {
                            shift: 3,
                            ..Word::unsigned(RegisterId(98), 0, 2)
                        },
                    )
                    .negated()
                    .plus([-0.12304020656595155, 0.0, -0.18524193653371793]),
                    direction_z: Field::<__Scene, ::qrt::circuit::format::UFixed<-4, 8>>::new(
                        1,
                        Word {
                            shift: 2,
                            ..Word::unsigned(RegisterId(98), 0, 2)
                        },
                    )
                    .plus([-1.0565138854669192, 0.0, 0.09262096826685896]),
                    distance: Field::<__Scene, ::qrt::circuit::format::UFixed<0, 8>>::new(
                        2,
                        Word::unsigned(RegisterId(99), 0, 8),
                    ),
                    sample_u: Field::<__Scene, ::qrt::circuit::format::UInt<1>>::new(
                        3,
                        Word::unsigned(RegisterId(3), 0, 1),
                    ),
                    sample_v: Field::<__Scene, ::qrt::circuit::format::UInt<1>>::new(
                        4,
                        Word::unsigned(RegisterId(4), 0, 1),
                    ),
                },
                ray1: LitFloorRay1 {
                    origin: Vector {
                        x: Field::<__Scene, ::qrt::circuit::format::Fixed<-1, 8>>::new(
                            5,
                            Word::signed(RegisterId(102), 0, 7),
                        ),
                        y: Field::<__Scene, ::qrt::circuit::format::Fixed<0, 8>>::new(
                            6,
                            Word::signed(RegisterId(103), 0, 8),
                        )
                        .plus([-0.0947265625, 0.0, 0.0]),
                        z: Field::<__Scene, ::qrt::circuit::format::Fixed<1, 8>>::new(
                            7,
                            Word::signed(RegisterId(104), 0, 9),
                        )
                        .plus([0.123046875, 0.0, 0.0]),
                    },
                    sample_u: Field::<__Scene, ::qrt::circuit::format::UInt<2>>::new(
                        8,
                        Word::unsigned(RegisterId(33), 0, 2),
                    ),
                    sample_v: Field::<__Scene, ::qrt::circuit::format::UInt<2>>::new(
                        9,
                        Word::unsigned(RegisterId(34), 0, 2),
                    ),
                },
            };
        }
        /// Registers by number.
        static R: [Declaration; 106] = [
            Declaration::at(0, "id", Type::UInt, Tag(1), 2),
            Declaration::at(1, "comparator", Type::UInt, Tag(2), 4),
            Declaration::at(2, "flag", Type::Bool, Tag(5), 1),
            Declaration::at(3, "ray0.sample.u", Type::UInt, Tag(0), 1).block(1),
            Declaration::at(4, "ray0.sample.v", Type::UInt, Tag(0), 1).block(1),
            Declaration::at(5, "add5", Type::UFixed { fraction: 8 }, Tag(0), 5).block(3),
            Declaration::at(6, "load6", Type::UFixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(7, "table7", Type::UFixed { fraction: 8 }, Tag(0), 2)
                .block(3)
                .scratch(8),
            Declaration::at(8, "table8", Type::Scratch, Tag(3), 0).block(3),
            Declaration::at(9, "add9", Type::UFixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(10, "divide10", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(3)
                .range(0, 136)
                .scratch(12),
            Declaration::at(11, "divide11", Type::Bool, Tag(0), 1).block(3),
            Declaration::at(12, "divide12", Type::Scratch, Tag(3), 8).block(3),
            Declaration::at(13, "load13", Type::Fixed { fraction: 8 }, Tag(0), 10).block(3),
            Declaration::at(14, "add14", Type::Fixed { fraction: 8 }, Tag(0), 10).block(3),
            Declaration::at(15, "multiply15", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(3)
                .range(-144, 0)
                .scratch(16),
            Declaration::at(16, "multiply16", Type::Scratch, Tag(3), 8).block(3),
            Declaration::at(17, "load17", Type::Fixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(18, "table18", Type::UFixed { fraction: 8 }, Tag(0), 5)
                .block(3)
                .scratch(19),
            Declaration::at(19, "table19", Type::Scratch, Tag(3), 0).block(3),
            Declaration::at(20, "add20", Type::Fixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(21, "multiply21", Type::Fixed { fraction: 8 }, Tag(0), 7)
                .block(3)
                .range(-50, 49)
                .scratch(22),
            Declaration::at(22, "multiply22", Type::Scratch, Tag(3), 8).block(3),
            Declaration::at(23, "add23", Type::Fixed { fraction: 8 }, Tag(0), 7).block(4),
            Declaration::at(24, "divide24", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(4)
                .range(0, 255),
            Declaration::at(25, "divide25", Type::Bool, Tag(0), 1).block(4),
            Declaration::at(26, "divide26", Type::Scratch, Tag(3), 0).block(4),
            Declaration::at(27, "multiply27", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(4)
                .range(-270, 0),
            Declaration::at(28, "multiply28", Type::Scratch, Tag(3), 0).block(4),
            Declaration::at(29, "multiply29", Type::Fixed { fraction: 8 }, Tag(0), 8)
                .block(4)
                .range(-94, 93),
            Declaration::at(30, "multiply30", Type::Scratch, Tag(3), 0).block(4),
            Declaration::at(31, "add31", Type::Fixed { fraction: 8 }, Tag(0), 9).block(4),
            Declaration::at(32, "add32", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(4)
                .range(-136, 255),
            Declaration::at(33, "ray1.sample.u", Type::UInt, Tag(0), 2).block(6),
            Declaration::at(34, "ray1.sample.v", Type::UInt, Tag(0), 2).block(6),
            Declaration::at(35, "add35", Type::Fixed { fraction: 8 }, Tag(0), 7)
                .block(11)
                .range(-50, 50),
            Declaration::at(36, "load36", Type::Fixed { fraction: 8 }, Tag(0), 9).block(12),
            Declaration::at(37, "add37", Type::Fixed { fraction: 8 }, Tag(0), 9).block(12),
            Declaration::at(38, "multiply38", Type::Fixed { fraction: 8 }, Tag(0), 8)
                .block(12)
                .range(-106, 0)
                .scratch(39),
            Declaration::at(39, "multiply39", Type::Scratch, Tag(3), 8).block(12),
            Declaration::at(40, "add40", Type::Fixed { fraction: 8 }, Tag(0), 8)
                .block(12)
                .range(-106, 2),
            Declaration::at(41, "add41", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(13)
                .range(-144, 3),
            Declaration::at(42, "add42", Type::UFixed { fraction: 8 }, Tag(0), 8).block(15),
            Declaration::at(43, "table43", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(15)
                .scratch(44),
            Declaration::at(44, "table44", Type::Scratch, Tag(3), 0).block(15),
            Declaration::at(45, "divide45", Type::UFixed { fraction: 8 }, Tag(0), 9)
                .block(15)
                .range(0, 478)
                .scratch(47),
            Declaration::at(46, "divide46", Type::Bool, Tag(0), 1).block(15),
            Declaration::at(47, "divide47", Type::Scratch, Tag(3), 8).block(15),
            Declaration::at(48, "table48", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(15)
                .scratch(49),
            Declaration::at(49, "table49", Type::Scratch, Tag(3), 0).block(15),
            Declaration::at(50, "multiply50", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(15)
                .range(-316, 315)
                .scratch(51),
            Declaration::at(51, "multiply51", Type::Scratch, Tag(3), 8).block(15),
            Declaration::at(52, "table52", Type::Fixed { fraction: 8 }, Tag(0), 9).block(15),
            Declaration::at(53, "table53", Type::Scratch, Tag(3), 0).block(15),
            Declaration::at(54, "multiply54", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(15)
                .range(-316, 315)
                .scratch(55),
            Declaration::at(55, "multiply55", Type::Scratch, Tag(3), 8).block(15),
            Declaration::at(56, "add56", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(15)
                .range(-460, 318),
            Declaration::at(57, "add57", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(15)
                .range(-366, 365),
            Declaration::at(58, "add58", Type::Fixed { fraction: 8 }, Tag(0), 10).block(15),
            Declaration::at(59, "add59", Type::Fixed { fraction: 8 }, Tag(0), 11).block(15),
            Declaration::at(60, "and60", Type::Bool, Tag(0), 1).block(15),
            Declaration::at(61, "add61", Type::Fixed { fraction: 8 }, Tag(0), 10).block(15),
            Declaration::at(62, "add62", Type::Fixed { fraction: 8 }, Tag(0), 10).block(15),
            Declaration::at(63, "and63", Type::Bool, Tag(0), 1).block(15),
            Declaration::at(64, "and64", Type::Bool, Tag(0), 1).block(15),
            Declaration::at(65, "select65", Type::UFixed { fraction: 8 }, Tag(0), 9)
                .block(15)
                .range(0, 511),
            Declaration::at(66, "select66", Type::UInt, Tag(0), 2).block(15),
            Declaration::at(67, "add67", Type::Fixed { fraction: 8 }, Tag(0), 8).block(16),
            Declaration::at(68, "divide68", Type::UFixed { fraction: 8 }, Tag(0), 9)
                .block(16)
                .range(0, 511),
            Declaration::at(69, "divide69", Type::Bool, Tag(0), 1).block(16),
            Declaration::at(70, "divide70", Type::Scratch, Tag(3), 0).block(16),
            Declaration::at(71, "and71", Type::Bool, Tag(0), 1).block(16),
            Declaration::at(72, "multiply72", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(16)
                .range(-338, 337),
            Declaration::at(73, "multiply73", Type::Scratch, Tag(3), 0).block(16),
            Declaration::at(74, "multiply74", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(16)
                .range(-338, 337),
            Declaration::at(75, "multiply75", Type::Scratch, Tag(3), 0).block(16),
            Declaration::at(76, "add76", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(16)
                .range(-482, 340),
            Declaration::at(77, "add77", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(16)
                .range(-388, 387),
            Declaration::at(78, "add78", Type::Fixed { fraction: 8 }, Tag(0), 11).block(16),
            Declaration::at(79, "add79", Type::Fixed { fraction: 8 }, Tag(0), 11).block(16),
            Declaration::at(80, "and80", Type::Bool, Tag(0), 1).block(16),
            Declaration::at(81, "add81", Type::Fixed { fraction: 8 }, Tag(0), 11).block(16),
            Declaration::at(82, "add82", Type::Fixed { fraction: 8 }, Tag(0), 11).block(16),
            Declaration::at(83, "and83", Type::Bool, Tag(0), 1).block(16),
            Declaration::at(84, "and84", Type::Bool, Tag(0), 1).block(16),
            Declaration::at(85, "add85", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(16)
                .range(-511, 511),
            Declaration::at(86, "colour.r", Type::UFixed { fraction: 8 }, Tag(4), 8)
                .block(20)
                .scratch(87),
            Declaration::at(87, "table87", Type::Scratch, Tag(3), 0).block(20),
            Declaration::at(88, "table88", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(20)
                .range(7, 212),
            Declaration::at(89, "table89", Type::Scratch, Tag(3), 0).block(20),
            Declaration::at(90, "colour.g", Type::UFixed { fraction: 8 }, Tag(4), 1)
                .block(21)
                .scratch(91),
            Declaration::at(91, "table91", Type::Scratch, Tag(3), 0).block(21),
            Declaration::at(92, "table92", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(21)
                .range(7, 135),
            Declaration::at(93, "table93", Type::Scratch, Tag(3), 0).block(21),
            Declaration::at(94, "colour.b", Type::UFixed { fraction: 8 }, Tag(4), 6)
                .block(22)
                .scratch(95),
            Declaration::at(95, "table95", Type::Scratch, Tag(3), 0).block(22),
            Declaration::at(96, "table96", Type::UFixed { fraction: 8 }, Tag(0), 6)
                .block(22)
                .range(7, 58),
            Declaration::at(97, "table97", Type::Scratch, Tag(3), 0).block(22),
            Declaration::at(
                98,
                "ray0.direction.y",
                Type::UFixed { fraction: 8 },
                Tag(0),
                2,
            )
            .block(2),
            Declaration::at(99, "ray0.distance", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(2)
                .range(0, 136),
            Declaration::at(100, "multiply15'", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(2)
                .range(-144, 0),
            Declaration::at(101, "multiply21'", Type::Fixed { fraction: 8 }, Tag(0), 7)
                .block(2)
                .range(-50, 49),
            Declaration::at(102, "ray1.origin.x", Type::Fixed { fraction: 8 }, Tag(0), 7)
                .range(-50, 50),
            Declaration::at(103, "ray1.origin.y", Type::Fixed { fraction: 8 }, Tag(0), 8)
                .range(-106, 2),
            Declaration::at(104, "ray1.origin.z", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .range(-144, 3),
            Declaration::at(105, "select66'", Type::UInt, Tag(0), 2),
        ];
        const BLOCKS: &[BlockDeclaration] = &[
            BlockDeclaration {
                parent: None,
                name: "oracle",
                tag: Tag(0),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "generate_ray",
                tag: Tag(72057598332895232),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "find_intersection",
                tag: Tag(144115192370823168),
            },
            BlockDeclaration {
                parent: Some(BlockId(2)),
                name: "plane 0",
                tag: Tag(18374686483966590976),
            },
            BlockDeclaration {
                parent: Some(BlockId(2)),
                name: "plane 1",
                tag: Tag(18374686483966590977),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "side",
                tag: Tag(216172786408751104),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "generate_ray",
                tag: Tag(72057602627862528),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "sample",
                tag: Tag(288230384741646336),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "x",
                tag: Tag(18230571300185702400),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "y",
                tag: Tag(18230571300185702401),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "z",
                tag: Tag(18230571300185702402),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "x",
                tag: Tag(18230571300185702400),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "y",
                tag: Tag(18230571300185702401),
            },
            BlockDeclaration {
                parent: Some(BlockId(6)),
                name: "z",
                tag: Tag(18230571300185702402),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "find_intersection",
                tag: Tag(144115196665790464),
            },
            BlockDeclaration {
                parent: Some(BlockId(14)),
                name: "plane 1",
                tag: Tag(18374686488261558273),
            },
            BlockDeclaration {
                parent: Some(BlockId(14)),
                name: "plane 0",
                tag: Tag(18374686488261558272),
            },
            BlockDeclaration {
                parent: Some(BlockId(14)),
                name: "plane 1",
                tag: Tag(18374686488261558273),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "side",
                tag: Tag(216172790703718400),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "shade",
                tag: Tag(360287978779574272),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "count",
                tag: Tag(432345564227567616),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "count",
                tag: Tag(432345564227567616),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "count",
                tag: Tag(432345564227567616),
            },
        ];
        static T7: &[i64] = &[0, 3];
        static T18: &[i64] = &[0, 27];
        static T43: &[i64] = &[239, 202, 157, 91];
        static T48: &[i64] = &[
            64, 111, 143, 169, -64, -111, -143, -169, -64, -111, -143, -169, 64, 111, 143, 169,
        ];
        static T52: &[i64] = &[
            64, 111, 143, 169, 64, 111, 143, 169, -64, -111, -143, -169, -64, -111, -143, -169,
        ];
        static T86: &[i64] = &[0, 205, 0, 0];
        static T88: &[i64] = &[7, 212, 7, 7];
        static T90: &[i64] = &[0, 1, 0, 0];
        static T92: &[i64] = &[7, 135, 7, 7];
        static T94: &[i64] = &[0, 51, 0, 0];
        static T96: &[i64] = &[7, 58, 7, 7];
        const PARAMETERS: &[PixelWord] = &[
            PixelWord::Shift {
                depth: 0,
                axis: 0,
                bits: 1,
            },
            PixelWord::Shift {
                depth: 0,
                axis: 1,
                bits: 1,
            },
            PixelWord::Affine {
                constant: 0.12304020656595155,
                along: [0.0, 0.18524193653371793],
                fraction: 8,
                width: 8,
            },
            PixelWord::Affine {
                constant: -1.0565138854669192,
                along: [0.0, 0.09262096826685896],
                fraction: 8,
                width: 10,
            },
            PixelWord::Affine {
                constant: -0.36243686707645817,
                along: [0.20710678118654752, 0.0],
                fraction: 8,
                width: 8,
            },
            PixelWord::Shift {
                depth: 1,
                axis: 0,
                bits: 2,
            },
            PixelWord::Shift {
                depth: 1,
                axis: 1,
                bits: 2,
            },
            PixelWord::Affine {
                constant: -0.12304020656595155,
                along: [0.0, -0.18524193653371793],
                fraction: 8,
                width: 9,
            },
        ];
        const CHANNELS: &[Channel] = &[
            Channel {
                number: 0,
                colour: Operand::Word(Word::unsigned(RegisterId(86), 0, 8)),
                count: Operand::Word(Word::unsigned(RegisterId(88), 4, 4)),
                scale: 1.0,
            },
            Channel {
                number: 1,
                colour: Operand::Word(Word {
                    shift: 7,
                    ..Word::unsigned(RegisterId(90), 0, 1)
                }),
                count: Operand::Word(Word::unsigned(RegisterId(92), 4, 4)),
                scale: 1.0,
            },
            Channel {
                number: 2,
                colour: Operand::Word(Word::unsigned(RegisterId(94), 0, 6)),
                count: Operand::Word(Word::unsigned(RegisterId(96), 4, 2)),
                scale: 1.0,
            },
        ];
        const PLACES: &[NamedPlace] = &[
            NamedPlace {
                name: Named {
                    depth: 0,
                    name: "direction",
                },
                component: 1,
                place: Place::Number {
                    word: Word {
                        shift: 3,
                        ..Word::unsigned(RegisterId(98), 0, 2)
                    },
                    negated: true,
                    offset: [-0.12304020656595155, 0.0, -0.18524193653371793],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 0,
                    name: "direction",
                },
                component: 2,
                place: Place::Number {
                    word: Word {
                        shift: 2,
                        ..Word::unsigned(RegisterId(98), 0, 2)
                    },
                    negated: false,
                    offset: [-1.0565138854669192, 0.0, 0.09262096826685896],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 0,
                    name: "distance",
                },
                component: 0,
                place: Place::Number {
                    word: Word::unsigned(RegisterId(99), 0, 8),
                    negated: false,
                    offset: [0.0, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 0,
                    name: "sample",
                },
                component: 0,
                place: Place::Index(Word::unsigned(RegisterId(3), 0, 1)),
            },
            NamedPlace {
                name: Named {
                    depth: 0,
                    name: "sample",
                },
                component: 1,
                place: Place::Index(Word::unsigned(RegisterId(4), 0, 1)),
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "origin",
                },
                component: 0,
                place: Place::Number {
                    word: Word::signed(RegisterId(102), 0, 7),
                    negated: false,
                    offset: [0.0, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "origin",
                },
                component: 1,
                place: Place::Number {
                    word: Word::signed(RegisterId(103), 0, 8),
                    negated: false,
                    offset: [-0.0947265625, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "origin",
                },
                component: 2,
                place: Place::Number {
                    word: Word::signed(RegisterId(104), 0, 9),
                    negated: false,
                    offset: [0.123046875, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "sample",
                },
                component: 0,
                place: Place::Index(Word::unsigned(RegisterId(33), 0, 2)),
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "sample",
                },
                component: 1,
                place: Place::Index(Word::unsigned(RegisterId(34), 0, 2)),
            },
        ];
        static OUTLINE: Outline = Outline {
            registers: &R,
            blocks: BLOCKS,
            order: &[
                RegisterId(3),
                RegisterId(4),
                RegisterId(5),
                RegisterId(6),
                RegisterId(7),
                RegisterId(9),
                RegisterId(10),
                RegisterId(13),
                RegisterId(14),
                RegisterId(15),
                RegisterId(17),
                RegisterId(18),
                RegisterId(20),
                RegisterId(21),
                RegisterId(33),
                RegisterId(34),
                RegisterId(35),
                RegisterId(36),
                RegisterId(37),
                RegisterId(38),
                RegisterId(40),
                RegisterId(41),
                RegisterId(42),
                RegisterId(43),
                RegisterId(45),
                RegisterId(48),
                RegisterId(50),
                RegisterId(54),
                RegisterId(56),
                RegisterId(57),
                RegisterId(58),
                RegisterId(59),
                RegisterId(60),
                RegisterId(61),
                RegisterId(62),
                RegisterId(63),
                RegisterId(64),
                RegisterId(66),
                RegisterId(86),
                RegisterId(90),
                RegisterId(94),
                RegisterId(98),
                RegisterId(99),
                RegisterId(100),
                RegisterId(101),
                RegisterId(102),
                RegisterId(103),
                RegisterId(104),
                RegisterId(105),
            ],
            parameters: PARAMETERS,
            style: Style::Lean,
            channels: CHANNELS,
            id: RegisterId(0),
            comparator: RegisterId(1),
            flag: RegisterId(2),
            fraction: 8,
            sharing: [87, 20],
            places: PLACES,
        };
        impl CompiledOracle for __Scene {
            const OUTLINE: &'static Outline = &OUTLINE;

            fn scene() -> &'static ::qrt::core::valid::ValidScene {
                __Scene::scene()
            }

            #[inline(always)]
            fn within<M: Machine, T>(
                m: &mut M,
                id: &M::Register,
                apply: impl FnOnce(&mut M, Computed<'_, Self, M::Register>) -> T,
            ) -> T {
                let (
                    ray0_sample_u_3,
                    ray0_sample_v_4,
                    ray0_direction_y_98,
                    ray0_distance_99,
                    multiply15__100,
                    multiply21__101,
                    ray1_sample_u_33,
                    ray1_sample_v_34,
                    ray1_origin_x_102,
                    ray1_origin_y_103,
                    ray1_origin_z_104,
                    add42,
                    table43,
                    divide45,
                    divide46,
                    table48,
                    table52,
                    multiply50,
                    multiply54,
                    add56,
                    add57,
                    add58,
                    add59,
                ) = {
                    m.block(BlockId(1));
                    let ray0_sample_u_3 = m.parity(&R[3], id, &[1, 0], Some(0));
                    let ray0_sample_v_4 = m.parity(&R[4], id, &[1, 1], Some(1));
                    m.block(BlockId(3));
                    let add5 = m.add(&R[5], Operand::Constant(16), Operand::Constant(0));
                    let load6 = m.load(&R[6], 2);
                    let [table7] = m.table([&R[7]], &[Bit::at(&ray0_sample_v_4, 0)], [T7], 0);
                    let add9 = m.add(
                        &R[9],
                        Operand::unsigned(&load6, 0, 8),
                        Word::unsigned(&table7, 0, 2).shifted(3).into(),
                    );
                    let [divide10, divide11] = m.divide(
                        &R[10],
                        &R[11],
                        Word::unsigned(&add5, 0, 5).shifted(8),
                        Word::unsigned(&add9, 0, 8),
                    );
                    let load13 = m.load(&R[13], 3);
                    let add14 = m.add(
                        &R[14],
                        Operand::signed(&load13, 0, 10),
                        Word::unsigned(&table7, 0, 2).shifted(2).into(),
                    );
                    let multiply15 = m.multiply(
                        &R[15],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add14, 0, 10),
                        8,
                    );
                    let load17 = m.load(&R[17], 4);
                    let [table18] = m.table([&R[18]], &[Bit::at(&ray0_sample_u_3, 0)], [T18], 0);
                    let add20 = m.add(
                        &R[20],
                        Operand::signed(&load17, 0, 8),
                        Operand::unsigned(&table18, 0, 5),
                    );
                    let multiply21 = m.multiply(
                        &R[21],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add20, 0, 8),
                        8,
                    );
                    m.block(BlockId(2));
                    let ray0_direction_y_98 = m.copy(&R[98], Word::unsigned(&table7, 0, 2));
                    let ray0_distance_99 = m.copy(&R[99], Word::unsigned(&divide10, 0, 8));
                    let multiply15__100 = m.copy(&R[100], Word::unsigned(&multiply15, 0, 9));
                    let multiply21__101 = m.copy(&R[101], Word::unsigned(&multiply21, 0, 7));
                    m.block(BlockId(3));
                    m.undo([multiply21]);
                    m.undo([add20]);
                    m.undo([table18]);
                    m.undo([load17]);
                    m.undo([multiply15]);
                    m.undo([add14]);
                    m.undo([load13]);
                    m.undo([divide10, divide11]);
                    m.undo([add9]);
                    m.undo([table7]);
                    m.undo([load6]);
                    m.undo([add5]);
                    let add5 = m.add(&R[5], Operand::Constant(16), Operand::Constant(0));
                    let load6 = m.load(&R[6], 2);
                    let [table7] = m.table([&R[7]], &[Bit::at(&ray0_sample_v_4, 0)], [T7], 0);
                    let add9 = m.add(
                        &R[9],
                        Operand::unsigned(&load6, 0, 8),
                        Word::unsigned(&table7, 0, 2).shifted(3).into(),
                    );
                    let [divide10, divide11] = m.divide(
                        &R[10],
                        &R[11],
                        Word::unsigned(&add5, 0, 5).shifted(8),
                        Word::unsigned(&add9, 0, 8),
                    );
                    let load13 = m.load(&R[13], 3);
                    let add14 = m.add(
                        &R[14],
                        Operand::signed(&load13, 0, 10),
                        Word::unsigned(&table7, 0, 2).shifted(2).into(),
                    );
                    let multiply15 = m.multiply(
                        &R[15],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add14, 0, 10),
                        8,
                    );
                    let load17 = m.load(&R[17], 4);
                    let [table18] = m.table([&R[18]], &[Bit::at(&ray0_sample_u_3, 0)], [T18], 0);
                    let add20 = m.add(
                        &R[20],
                        Operand::signed(&load17, 0, 8),
                        Operand::unsigned(&table18, 0, 5),
                    );
                    let multiply21 = m.multiply(
                        &R[21],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add20, 0, 8),
                        8,
                    );
                    m.undo([multiply21]);
                    m.undo([add20]);
                    m.undo([table18]);
                    m.undo([load17]);
                    m.undo([multiply15]);
                    m.undo([add14]);
                    m.undo([load13]);
                    m.undo([divide10, divide11]);
                    m.undo([add9]);
                    m.undo([table7]);
                    m.undo([load6]);
                    m.undo([add5]);
                    m.block(BlockId(6));
                    let ray1_sample_u_33 = m.parity(&R[33], id, &[2, 3], Some(5));
                    let ray1_sample_v_34 = m.parity(&R[34], id, &[2, 3], Some(6));
                    m.block(BlockId(11));
                    let add35 = m.subtract(
                        &R[35],
                        Operand::signed(&multiply21__101, 0, 7),
                        Operand::signed(&multiply21__101, 6, 1),
                    );
                    m.block(BlockId(12));
                    let load36 = m.load(&R[36], 7);
                    let add37 = m.subtract(
                        &R[37],
                        Operand::signed(&load36, 0, 9),
                        Word::unsigned(&ray0_direction_y_98, 0, 2).shifted(3).into(),
                    );
                    let multiply38 = m.multiply(
                        &R[38],
                        Word::unsigned(&ray0_distance_99, 0, 8),
                        Word::signed(&add37, 0, 9),
                        8,
                    );
                    let add40 = m.subtract(
                        &R[40],
                        Operand::signed(&multiply38, 0, 8),
                        Operand::signed(&multiply38, 6, 2),
                    );
                    m.undo([multiply38]);
                    m.undo([add37]);
                    m.undo([load36]);
                    m.block(BlockId(13));
                    let add41 = m.subtract(
                        &R[41],
                        Operand::signed(&multiply15__100, 0, 9),
                        Operand::signed(&multiply15__100, 6, 3),
                    );
                    m.block(BlockId(0));
                    let ray1_origin_x_102 = m.copy(&R[102], Word::unsigned(&add35, 0, 7));
                    let ray1_origin_y_103 = m.copy(&R[103], Word::unsigned(&add40, 0, 8));
                    let ray1_origin_z_104 = m.copy(&R[104], Word::unsigned(&add41, 0, 9));
                    m.block(BlockId(13));
                    m.undo([add41]);
                    m.block(BlockId(12));
                    let load36 = m.load(&R[36], 7);
                    let add37 = m.subtract(
                        &R[37],
                        Operand::signed(&load36, 0, 9),
                        Word::unsigned(&ray0_direction_y_98, 0, 2).shifted(3).into(),
                    );
                    let multiply38 = m.multiply(
                        &R[38],
                        Word::unsigned(&ray0_distance_99, 0, 8),
                        Word::signed(&add37, 0, 9),
                        8,
                    );
                    m.undo([add40]);
                    m.undo([multiply38]);
                    m.undo([add37]);
                    m.undo([load36]);
                    m.block(BlockId(11));
                    m.undo([add35]);
                    m.block(BlockId(15));
                    let add42 = m.subtract(
                        &R[42],
                        Operand::Constant(64),
                        Operand::signed(&ray1_origin_y_103, 0, 8),
                    );
                    let [table43] = m.table(
                        [&R[43]],
                        &[Bit::at(&ray1_sample_u_33, 0), Bit::at(&ray1_sample_u_33, 1)],
                        [T43],
                        0,
                    );
                    let [divide45, divide46] = m.divide(
                        &R[45],
                        &R[46],
                        Word::unsigned(&add42, 0, 8).shifted(8),
                        Word::unsigned(&table43, 0, 8),
                    );
                    let [table48, table52] = m.table(
                        [&R[48], &R[52]],
                        &[
                            Bit::at(&ray1_sample_u_33, 0),
                            Bit::at(&ray1_sample_u_33, 1),
                            Bit::at(&ray1_sample_v_34, 0),
                            Bit::at(&ray1_sample_v_34, 1),
                        ],
                        [T48, T52],
                        0,
                    );
                    let multiply50 = m.multiply(
                        &R[50],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table48, 0, 9),
                        8,
                    );
                    let multiply54 = m.multiply(
                        &R[54],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table52, 0, 9),
                        8,
                    );
                    let add56 = m.add(
                        &R[56],
                        Operand::signed(&ray1_origin_z_104, 0, 9),
                        Operand::signed(&multiply50, 0, 10),
                    );
                    let add57 = m.add(
                        &R[57],
                        Operand::signed(&ray1_origin_x_102, 0, 7),
                        Operand::signed(&multiply54, 0, 10),
                    );
                    let add58 = m.add(
                        &R[58],
                        Operand::Constant(177),
                        Operand::signed(&add56, 0, 10),
                    );
                    let add59 = m.subtract(
                        &R[59],
                        Operand::Constant(113),
                        Operand::signed(&add56, 0, 10),
                    );
                    (
                        ray0_sample_u_3,
                        ray0_sample_v_4,
                        ray0_direction_y_98,
                        ray0_distance_99,
                        multiply15__100,
                        multiply21__101,
                        ray1_sample_u_33,
                        ray1_sample_v_34,
                        ray1_origin_x_102,
                        ray1_origin_y_103,
                        ray1_origin_z_104,
                        add42,
                        table43,
                        divide45,
                        divide46,
                        table48,
                        table52,
                        multiply50,
                        multiply54,
                        add56,
                        add57,
                        add58,
                        add59,
                    )
                };
                let (
                    select66__105,
                    colour_r_86,
                    table88,
                    colour_g_90,
                    table92,
                    colour_b_94,
                    table96,
                ) = {
                    let and60 = m.and(
                        &R[60],
                        Bit::at(&add58, 9).inverted(),
                        Bit::at(&add59, 10).inverted(),
                    );
                    let add61 = m.add(
                        &R[61],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let add62 = m.subtract(
                        &R[62],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let and63 = m.and(
                        &R[63],
                        Bit::at(&add61, 9).inverted(),
                        Bit::at(&add62, 9).inverted(),
                    );
                    let and64 = m.and(&R[64], Bit::at(&and60, 0), Bit::at(&and63, 0));
                    let select66 = m.select(
                        &R[66],
                        Bit::at(&and64, 0),
                        Operand::Constant(1),
                        Operand::Constant(2),
                    );
                    m.undo([and64]);
                    m.undo([and63]);
                    m.undo([add62]);
                    m.undo([add61]);
                    m.undo([and60]);
                    m.undo([add59]);
                    m.undo([add58]);
                    m.undo([add57]);
                    m.undo([add56]);
                    m.undo([multiply54]);
                    m.undo([multiply50]);
                    m.undo([table48, table52]);
                    m.undo([divide45, divide46]);
                    m.undo([table43]);
                    m.undo([add42]);
                    m.block(BlockId(0));
                    let select66__105 = m.copy(&R[105], Word::unsigned(&select66, 0, 2));
                    m.block(BlockId(15));
                    let add42 = m.subtract(
                        &R[42],
                        Operand::Constant(64),
                        Operand::signed(&ray1_origin_y_103, 0, 8),
                    );
                    let [table43] = m.table(
                        [&R[43]],
                        &[Bit::at(&ray1_sample_u_33, 0), Bit::at(&ray1_sample_u_33, 1)],
                        [T43],
                        0,
                    );
                    let [divide45, divide46] = m.divide(
                        &R[45],
                        &R[46],
                        Word::unsigned(&add42, 0, 8).shifted(8),
                        Word::unsigned(&table43, 0, 8),
                    );
                    let [table48, table52] = m.table(
                        [&R[48], &R[52]],
                        &[
                            Bit::at(&ray1_sample_u_33, 0),
                            Bit::at(&ray1_sample_u_33, 1),
                            Bit::at(&ray1_sample_v_34, 0),
                            Bit::at(&ray1_sample_v_34, 1),
                        ],
                        [T48, T52],
                        0,
                    );
                    let multiply50 = m.multiply(
                        &R[50],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table48, 0, 9),
                        8,
                    );
                    let multiply54 = m.multiply(
                        &R[54],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table52, 0, 9),
                        8,
                    );
                    let add56 = m.add(
                        &R[56],
                        Operand::signed(&ray1_origin_z_104, 0, 9),
                        Operand::signed(&multiply50, 0, 10),
                    );
                    let add57 = m.add(
                        &R[57],
                        Operand::signed(&ray1_origin_x_102, 0, 7),
                        Operand::signed(&multiply54, 0, 10),
                    );
                    let add58 = m.add(
                        &R[58],
                        Operand::Constant(177),
                        Operand::signed(&add56, 0, 10),
                    );
                    let add59 = m.subtract(
                        &R[59],
                        Operand::Constant(113),
                        Operand::signed(&add56, 0, 10),
                    );
                    let and60 = m.and(
                        &R[60],
                        Bit::at(&add58, 9).inverted(),
                        Bit::at(&add59, 10).inverted(),
                    );
                    let add61 = m.add(
                        &R[61],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let add62 = m.subtract(
                        &R[62],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let and63 = m.and(
                        &R[63],
                        Bit::at(&add61, 9).inverted(),
                        Bit::at(&add62, 9).inverted(),
                    );
                    let and64 = m.and(&R[64], Bit::at(&and60, 0), Bit::at(&and63, 0));
                    m.undo([select66]);
                    m.undo([and64]);
                    m.undo([and63]);
                    m.undo([add62]);
                    m.undo([add61]);
                    m.undo([and60]);
                    m.undo([add59]);
                    m.undo([add58]);
                    m.undo([add57]);
                    m.undo([add56]);
                    m.undo([multiply54]);
                    m.undo([multiply50]);
                    m.undo([table48, table52]);
                    m.undo([divide45, divide46]);
                    m.undo([table43]);
                    m.undo([add42]);
                    m.block(BlockId(20));
                    let [colour_r_86, table88] = m.table(
                        [&R[86], &R[88]],
                        &[Bit::at(&select66__105, 0), Bit::at(&select66__105, 1)],
                        [T86, T88],
                        0,
                    );
                    m.block(BlockId(21));
                    let [colour_g_90, table92] = m.table(
                        [&R[90], &R[92]],
                        &[Bit::at(&select66__105, 0), Bit::at(&select66__105, 1)],
                        [T90, T92],
                        0,
                    );
                    m.block(BlockId(22));
                    let [colour_b_94, table96] = m.table(
                        [&R[94], &R[96]],
                        &[Bit::at(&select66__105, 0), Bit::at(&select66__105, 1)],
                        [T94, T96],
                        0,
                    );
                    (
                        select66__105,
                        colour_r_86,
                        table88,
                        colour_g_90,
                        table92,
                        colour_b_94,
                        table96,
                    )
                };

                let fields = &[
                    &ray0_direction_y_98,
                    &ray0_direction_y_98,
                    &ray0_distance_99,
                    &ray0_sample_u_3,
                    &ray0_sample_v_4,
                    &ray1_origin_x_102,
                    &ray1_origin_y_103,
                    &ray1_origin_z_104,
                    &ray1_sample_u_33,
                    &ray1_sample_v_34,
                ];
                let channels = [
                    [
                        Operand::unsigned(&table88, 4, 4),
                        Operand::unsigned(&colour_r_86, 0, 8),
                    ],
                    [
                        Operand::unsigned(&table92, 4, 4),
                        Word::unsigned(&colour_g_90, 0, 1).shifted(7).into(),
                    ],
                    [
                        Operand::unsigned(&table96, 4, 2),
                        Operand::unsigned(&colour_b_94, 0, 6),
                    ],
                ];
                let applied = apply(m, Computed::new(fields, channels));
                let () = {
                    m.undo([colour_b_94, table96]);
                    m.block(BlockId(21));
                    m.undo([colour_g_90, table92]);
                    m.block(BlockId(20));
                    m.undo([colour_r_86, table88]);
                    m.block(BlockId(15));
                    let add42 = m.subtract(
                        &R[42],
                        Operand::Constant(64),
                        Operand::signed(&ray1_origin_y_103, 0, 8),
                    );
                    let [table43] = m.table(
                        [&R[43]],
                        &[Bit::at(&ray1_sample_u_33, 0), Bit::at(&ray1_sample_u_33, 1)],
                        [T43],
                        0,
                    );
                    let [divide45, divide46] = m.divide(
                        &R[45],
                        &R[46],
                        Word::unsigned(&add42, 0, 8).shifted(8),
                        Word::unsigned(&table43, 0, 8),
                    );
                    let [table48, table52] = m.table(
                        [&R[48], &R[52]],
                        &[
                            Bit::at(&ray1_sample_u_33, 0),
                            Bit::at(&ray1_sample_u_33, 1),
                            Bit::at(&ray1_sample_v_34, 0),
                            Bit::at(&ray1_sample_v_34, 1),
                        ],
                        [T48, T52],
                        0,
                    );
                    let multiply50 = m.multiply(
                        &R[50],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table48, 0, 9),
                        8,
                    );
                    let multiply54 = m.multiply(
                        &R[54],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table52, 0, 9),
                        8,
                    );
                    let add56 = m.add(
                        &R[56],
                        Operand::signed(&ray1_origin_z_104, 0, 9),
                        Operand::signed(&multiply50, 0, 10),
                    );
                    let add57 = m.add(
                        &R[57],
                        Operand::signed(&ray1_origin_x_102, 0, 7),
                        Operand::signed(&multiply54, 0, 10),
                    );
                    let add58 = m.add(
                        &R[58],
                        Operand::Constant(177),
                        Operand::signed(&add56, 0, 10),
                    );
                    let add59 = m.subtract(
                        &R[59],
                        Operand::Constant(113),
                        Operand::signed(&add56, 0, 10),
                    );
                    let and60 = m.and(
                        &R[60],
                        Bit::at(&add58, 9).inverted(),
                        Bit::at(&add59, 10).inverted(),
                    );
                    let add61 = m.add(
                        &R[61],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let add62 = m.subtract(
                        &R[62],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let and63 = m.and(
                        &R[63],
                        Bit::at(&add61, 9).inverted(),
                        Bit::at(&add62, 9).inverted(),
                    );
                    let and64 = m.and(&R[64], Bit::at(&and60, 0), Bit::at(&and63, 0));
                    let select66 = m.select(
                        &R[66],
                        Bit::at(&and64, 0),
                        Operand::Constant(1),
                        Operand::Constant(2),
                    );
                    m.undo([and64]);
                    m.undo([and63]);
                    m.undo([add62]);
                    m.undo([add61]);
                    m.undo([and60]);
                    m.undo([add59]);
                    m.undo([add58]);
                    m.undo([add57]);
                    m.undo([add56]);
                    m.undo([multiply54]);
                    m.undo([multiply50]);
                    m.undo([table48, table52]);
                    m.undo([divide45, divide46]);
                    m.undo([table43]);
                    m.undo([add42]);
                    m.block(BlockId(0));
                    m.undo([select66__105]);
                    m.block(BlockId(15));
                    let add42 = m.subtract(
                        &R[42],
                        Operand::Constant(64),
                        Operand::signed(&ray1_origin_y_103, 0, 8),
                    );
                    let [table43] = m.table(
                        [&R[43]],
                        &[Bit::at(&ray1_sample_u_33, 0), Bit::at(&ray1_sample_u_33, 1)],
                        [T43],
                        0,
                    );
                    let [divide45, divide46] = m.divide(
                        &R[45],
                        &R[46],
                        Word::unsigned(&add42, 0, 8).shifted(8),
                        Word::unsigned(&table43, 0, 8),
                    );
                    let [table48, table52] = m.table(
                        [&R[48], &R[52]],
                        &[
                            Bit::at(&ray1_sample_u_33, 0),
                            Bit::at(&ray1_sample_u_33, 1),
                            Bit::at(&ray1_sample_v_34, 0),
                            Bit::at(&ray1_sample_v_34, 1),
                        ],
                        [T48, T52],
                        0,
                    );
                    let multiply50 = m.multiply(
                        &R[50],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table48, 0, 9),
                        8,
                    );
                    let multiply54 = m.multiply(
                        &R[54],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&table52, 0, 9),
                        8,
                    );
                    let add56 = m.add(
                        &R[56],
                        Operand::signed(&ray1_origin_z_104, 0, 9),
                        Operand::signed(&multiply50, 0, 10),
                    );
                    let add57 = m.add(
                        &R[57],
                        Operand::signed(&ray1_origin_x_102, 0, 7),
                        Operand::signed(&multiply54, 0, 10),
                    );
                    let add58 = m.add(
                        &R[58],
                        Operand::Constant(177),
                        Operand::signed(&add56, 0, 10),
                    );
                    let add59 = m.subtract(
                        &R[59],
                        Operand::Constant(113),
                        Operand::signed(&add56, 0, 10),
                    );
                    let and60 = m.and(
                        &R[60],
                        Bit::at(&add58, 9).inverted(),
                        Bit::at(&add59, 10).inverted(),
                    );
                    let add61 = m.add(
                        &R[61],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let add62 = m.subtract(
                        &R[62],
                        Operand::Constant(145),
                        Operand::signed(&add57, 0, 10),
                    );
                    let and63 = m.and(
                        &R[63],
                        Bit::at(&add61, 9).inverted(),
                        Bit::at(&add62, 9).inverted(),
                    );
                    let and64 = m.and(&R[64], Bit::at(&and60, 0), Bit::at(&and63, 0));
                    m.undo([select66]);
                    m.undo([and64]);
                    m.undo([and63]);
                    m.undo([add62]);
                    m.undo([add61]);
                    m.undo([and60]);
                    m.undo([add59]);
                    m.undo([add58]);
                    m.undo([add57]);
                    m.undo([add56]);
                    m.undo([multiply54]);
                    m.undo([multiply50]);
                    m.undo([table48, table52]);
                    m.undo([divide45, divide46]);
                    m.undo([table43]);
                    m.undo([add42]);
                    m.block(BlockId(11));
                    let add35 = m.subtract(
                        &R[35],
                        Operand::signed(&multiply21__101, 0, 7),
                        Operand::signed(&multiply21__101, 6, 1),
                    );
                    m.block(BlockId(12));
                    let load36 = m.load(&R[36], 7);
                    let add37 = m.subtract(
                        &R[37],
                        Operand::signed(&load36, 0, 9),
                        Word::unsigned(&ray0_direction_y_98, 0, 2).shifted(3).into(),
                    );
                    let multiply38 = m.multiply(
                        &R[38],
                        Word::unsigned(&ray0_distance_99, 0, 8),
                        Word::signed(&add37, 0, 9),
                        8,
                    );
                    let add40 = m.subtract(
                        &R[40],
                        Operand::signed(&multiply38, 0, 8),
                        Operand::signed(&multiply38, 6, 2),
                    );
                    m.undo([multiply38]);
                    m.undo([add37]);
                    m.undo([load36]);
                    m.block(BlockId(13));
                    let add41 = m.subtract(
                        &R[41],
                        Operand::signed(&multiply15__100, 0, 9),
                        Operand::signed(&multiply15__100, 6, 3),
                    );
                    m.block(BlockId(0));
                    m.undo([ray1_origin_z_104]);
                    m.undo([ray1_origin_y_103]);
                    m.undo([ray1_origin_x_102]);
                    m.block(BlockId(13));
                    m.undo([add41]);
                    m.block(BlockId(12));
                    let load36 = m.load(&R[36], 7);
                    let add37 = m.subtract(
                        &R[37],
                        Operand::signed(&load36, 0, 9),
                        Word::unsigned(&ray0_direction_y_98, 0, 2).shifted(3).into(),
                    );
                    let multiply38 = m.multiply(
                        &R[38],
                        Word::unsigned(&ray0_distance_99, 0, 8),
                        Word::signed(&add37, 0, 9),
                        8,
                    );
                    m.undo([add40]);
                    m.undo([multiply38]);
                    m.undo([add37]);
                    m.undo([load36]);
                    m.block(BlockId(11));
                    m.undo([add35]);
                    m.block(BlockId(6));
                    ()
                };
                let () = {
                    m.undo([ray1_sample_v_34]);
                    m.undo([ray1_sample_u_33]);
                    m.block(BlockId(3));
                    let add5 = m.add(&R[5], Operand::Constant(16), Operand::Constant(0));
                    let load6 = m.load(&R[6], 2);
                    let [table7] = m.table([&R[7]], &[Bit::at(&ray0_sample_v_4, 0)], [T7], 0);
                    let add9 = m.add(
                        &R[9],
                        Operand::unsigned(&load6, 0, 8),
                        Word::unsigned(&table7, 0, 2).shifted(3).into(),
                    );
                    let [divide10, divide11] = m.divide(
                        &R[10],
                        &R[11],
                        Word::unsigned(&add5, 0, 5).shifted(8),
                        Word::unsigned(&add9, 0, 8),
                    );
                    let load13 = m.load(&R[13], 3);
                    let add14 = m.add(
                        &R[14],
                        Operand::signed(&load13, 0, 10),
                        Word::unsigned(&table7, 0, 2).shifted(2).into(),
                    );
                    let multiply15 = m.multiply(
                        &R[15],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add14, 0, 10),
                        8,
                    );
                    let load17 = m.load(&R[17], 4);
                    let [table18] = m.table([&R[18]], &[Bit::at(&ray0_sample_u_3, 0)], [T18], 0);
                    let add20 = m.add(
                        &R[20],
                        Operand::signed(&load17, 0, 8),
                        Operand::unsigned(&table18, 0, 5),
                    );
                    let multiply21 = m.multiply(
                        &R[21],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add20, 0, 8),
                        8,
                    );
                    m.undo([multiply21]);
                    m.undo([add20]);
                    m.undo([table18]);
                    m.undo([load17]);
                    m.undo([multiply15]);
                    m.undo([add14]);
                    m.undo([load13]);
                    m.undo([divide10, divide11]);
                    m.undo([add9]);
                    m.undo([table7]);
                    m.undo([load6]);
                    m.undo([add5]);
                    let add5 = m.add(&R[5], Operand::Constant(16), Operand::Constant(0));
                    let load6 = m.load(&R[6], 2);
                    let [table7] = m.table([&R[7]], &[Bit::at(&ray0_sample_v_4, 0)], [T7], 0);
                    let add9 = m.add(
                        &R[9],
                        Operand::unsigned(&load6, 0, 8),
                        Word::unsigned(&table7, 0, 2).shifted(3).into(),
                    );
                    let [divide10, divide11] = m.divide(
                        &R[10],
                        &R[11],
                        Word::unsigned(&add5, 0, 5).shifted(8),
                        Word::unsigned(&add9, 0, 8),
                    );
                    let load13 = m.load(&R[13], 3);
                    let add14 = m.add(
                        &R[14],
                        Operand::signed(&load13, 0, 10),
                        Word::unsigned(&table7, 0, 2).shifted(2).into(),
                    );
                    let multiply15 = m.multiply(
                        &R[15],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add14, 0, 10),
                        8,
                    );
                    let load17 = m.load(&R[17], 4);
                    let [table18] = m.table([&R[18]], &[Bit::at(&ray0_sample_u_3, 0)], [T18], 0);
                    let add20 = m.add(
                        &R[20],
                        Operand::signed(&load17, 0, 8),
                        Operand::unsigned(&table18, 0, 5),
                    );
                    let multiply21 = m.multiply(
                        &R[21],
                        Word::unsigned(&divide10, 0, 8),
                        Word::signed(&add20, 0, 8),
                        8,
                    );
                    m.block(BlockId(2));
                    m.undo([multiply21__101]);
                    m.undo([multiply15__100]);
                    m.undo([ray0_distance_99]);
                    m.undo([ray0_direction_y_98]);
                    m.block(BlockId(3));
                    m.undo([multiply21]);
                    m.undo([add20]);
                    m.undo([table18]);
                    m.undo([load17]);
                    m.undo([multiply15]);
                    m.undo([add14]);
                    m.undo([load13]);
                    m.undo([divide10, divide11]);
                    m.undo([add9]);
                    m.undo([table7]);
                    m.undo([load6]);
                    m.undo([add5]);
                    m.block(BlockId(1));
                    m.undo([ray0_sample_v_4]);
                    m.undo([ray0_sample_u_3]);
                    ()
                };

                applied
            }
        }
        static N7: [i32; 16] = [0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N18: [i32; 16] = [0, 27, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N43: [i32; 16] = [239, 202, 157, 91, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N48: [i32; 16] = [
            64, 111, 143, 169, -64, -111, -143, -169, -64, -111, -143, -169, 64, 111, 143, 169,
        ];
        static N52: [i32; 16] = [
            64, 111, 143, 169, 64, 111, 143, 169, -64, -111, -143, -169, -64, -111, -143, -169,
        ];
        static N86: [i32; 16] = [0, 205, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N88: [i32; 16] = [7, 212, 7, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N92: [i32; 16] = [7, 135, 7, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N94: [i32; 16] = [0, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        static N96: [i32; 16] = [7, 58, 7, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

        impl NativeOracle for __Scene {
            #[inline(always)]
            fn native<V: Vectors>(v: V, words: &[u64], ids: V::Longs) -> [[V::Longs; 3]; 2] {
                let (add57, add59, t100) = {
                    let t1 = ids;
                    let t2 = v.narrow(t1);
                    let t3 = v.ints(word(words, 0, 1, false) as i32);
                    let t4 = v.table16(&[0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1], t2);
                    let t5 = t4.xor(t3);
                    let ray0_sample_u_3 = t5.has(1);
                    let t7 = v.ints(word(words, 1, 1, false) as i32);
                    let t8 = v.table16(&[0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0], t2);
                    let t9 = t8.xor(t7);
                    let ray0_sample_v_4 = t9.has(1);
                    let add5 = v.ints(16).add(v.ints(0));
                    let load6 = v.ints(word(words, 2, 8, false) as i32);
                    let t13 = v.ints(1).choose(ray0_sample_v_4, v.ints(0));
                    let table7 = v.table16(&N7, t13);
                    let t15 = table7.left(3);
                    let t16 = load6.add(t15);
                    let add9 = t16.lowest(8);
                    let t18 = add5.less(add9);
                    let t19 = add5.choose(t18, v.ints(0));
                    let t20 = v.quotient_single(t19, add9, 8);
                    let t21 = t20.mul(add9);
                    let t22 = t19.left(8).sub(t21);
                    let t23 = t22.less(v.ints(0));
                    let t24 = t20.sub(v.ints(1)).choose(t23, t20);
                    let t25 = add9.less(v.ints(1));
                    let divide10 = v.ints(255).choose(t25, t24);
                    let load13 = v.ints(word(words, 3, 10, true) as i32);
                    let t28 = table7.left(2);
                    let t29 = load13.add(t28);
                    let add14 = t29.left(22).right(22);
                    let t31 = divide10.mul(add14).right(8);
                    let multiply15 = t31.left(23).right(23);
                    let load17 = v.ints(word(words, 4, 8, true) as i32);
                    let t34 = v.ints(1).choose(ray0_sample_u_3, v.ints(0));
                    let table18 = v.table16(&N18, t34);
                    let t36 = load17.add(table18);
                    let add20 = t36.left(24).right(24);
                    let t38 = divide10.mul(add20).right(8);
                    let multiply21 = t38.left(25).right(25);
                    let t40 = multiply15.lowest(9);
                    let multiply15__100 = t40.left(23).right(23);
                    let t42 = multiply21.lowest(7);
                    let multiply21__101 = t42.left(25).right(25);
                    let t44 = v.ints(word(words, 5, 2, false) as i32);
                    let t45 = v.table16(&[0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1], t2);
                    let ray1_sample_u_33 = t45.xor(t44);
                    let t47 = v.ints(word(words, 6, 2, false) as i32);
                    let t48 = v.table16(&[0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1], t2);
                    let ray1_sample_v_34 = t48.xor(t47);
                    let t50 = multiply21__101.right(6);
                    let add35 = multiply21__101.sub(t50);
                    let load36 = v.ints(word(words, 7, 9, true) as i32);
                    let t53 = table7.left(3);
                    let t54 = load36.sub(t53);
                    let add37 = t54.left(23).right(23);
                    let t56 = divide10.mul(add37).right(8);
                    let multiply38 = t56.left(24).right(24);
                    let t58 = multiply38.right(6);
                    let add40 = multiply38.sub(t58);
                    let t60 = multiply15__100.right(6);
                    let add41 = multiply15__100.sub(t60);
                    let t62 = add35.lowest(7);
                    let ray1_origin_x_102 = t62.left(25).right(25);
                    let t64 = add40.lowest(8);
                    let ray1_origin_y_103 = t64.left(24).right(24);
                    let t66 = add41.lowest(9);
                    let ray1_origin_z_104 = t66.left(23).right(23);
                    let add42 = v.ints(64).sub(ray1_origin_y_103);
                    let table43 = v.table16(&N43, ray1_sample_u_33);
                    let t70 = add42.right(1);
                    let t71 = t70.less(table43);
                    let t72 = add42.choose(t71, v.ints(0));
                    let t73 = v.quotient_single(t72, table43, 8);
                    let t74 = t73.mul(table43);
                    let t75 = t72.left(8).sub(t74);
                    let t76 = t75.less(v.ints(0));
                    let t77 = t73.sub(v.ints(1)).choose(t76, t73);
                    let t78 = table43.less(v.ints(1));
                    let divide45 = v.ints(511).choose(t78, t77);
                    let t80 = ray1_sample_u_33.has(1);
                    let t81 = v.ints(0).add(v.ints(1));
                    let t82 = t81.choose(t80, v.ints(0));
                    let t83 = ray1_sample_u_33.has(2);
                    let t84 = t82.add(v.ints(2));
                    let t85 = t84.choose(t83, t82);
                    let t86 = ray1_sample_v_34.has(1);
                    let t87 = t85.add(v.ints(4));
                    let t88 = t87.choose(t86, t85);
                    let t89 = ray1_sample_v_34.has(2);
                    let t90 = t88.add(v.ints(8));
                    let t91 = t90.choose(t89, t88);
                    let table48 = v.table16(&N48, t91);
                    let table52 = v.table16(&N52, t91);
                    let multiply50 = divide45.mul(table48).right(8);
                    let multiply54 = divide45.mul(table52).right(8);
                    let add56 = ray1_origin_z_104.add(multiply50);
                    let add57 = ray1_origin_x_102.add(multiply54);
                    let add58 = v.ints(177).add(add56);
                    let add59 = v.ints(113).sub(add56);
                    let t100 = add58.less(v.ints(0));
                    (add57, add59, t100)
                };
                let (t121, t122, t124, t127, t129, t130) = {
                    let t101 = t100.not();
                    let t102 = add59.less(v.ints(0));
                    let t103 = t102.not();
                    let and60 = t101.and(t103);
                    let add61 = v.ints(145).add(add57);
                    let add62 = v.ints(145).sub(add57);
                    let t107 = add61.less(v.ints(0));
                    let t108 = t107.not();
                    let t109 = add62.less(v.ints(0));
                    let t110 = t109.not();
                    let and63 = t108.and(t110);
                    let and64 = and60.and(and63);
                    let select66 = v.ints(1).choose(and64, v.ints(2));
                    let colour_r_86 = v.table16(&N86, select66);
                    let table88 = v.table16(&N88, select66);
                    let colour_g_90 = v.marks(2, select66);
                    let table92 = v.table16(&N92, select66);
                    let colour_b_94 = v.table16(&N94, select66);
                    let table96 = v.table16(&N96, select66);
                    let t120 = table88.right(4);
                    let t121 = v.widen(t120);
                    let t122 = v.widen(colour_r_86);
                    let t123 = table92.right(4);
                    let t124 = v.widen(t123);
                    let t125 = v.ints(1).choose(colour_g_90, v.ints(0));
                    let t126 = t125.left(7);
                    let t127 = v.widen(t126);
                    let t128 = table96.right(4);
                    let t129 = v.widen(t128);
                    let t130 = v.widen(colour_b_94);
                    (t121, t122, t124, t127, t129, t130)
                };

                [[t121, t124, t129], [t122, t127, t130]]
            }
        }
    };
};
