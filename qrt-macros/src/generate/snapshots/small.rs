#[allow(dead_code, reason = "an author asks for some of them only")]
impl LitFloor {
    /// The most qubits in use at any time during a call of the oracle of the channel that
    /// has the most Toffolis.
    pub const QUBITS: u64 = 994;
    /// Toffoli gates of a call of the oracle of the channel that has the most.
    pub const TOFFOLI: u64 = 1560;
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
    pub const OPERATIONS: usize = 39;
}

/// Numbers of the primary ray of [`LitFloor`] that are in registers.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LitFloorRay0 {
    /// Where it goes; the camera's are of no particular length.
    pub direction: ::qrt::core::oracle::compiled::Vector<
        LitFloor,
        ::qrt::circuit::format::UFixed<-3, 8>,
        ::qrt::circuit::format::UFixed<-3, 8>,
        ::qrt::circuit::format::UFixed<-4, 8>,
    >,
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
    /// Where it goes; the camera's are of no particular length.
    pub direction: ::qrt::core::oracle::compiled::Vector<
        LitFloor,
        ::qrt::circuit::format::Fixed<1, 8>,
        ::qrt::circuit::format::UFixed<0, 8>,
        ::qrt::circuit::format::Fixed<1, 8>,
    >,
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
                    direction: Vector {
                        x: Field::<__Scene, ::qrt::circuit::format::UFixed<-3, 8>>::new(
                            0,
                            Word::unsigned(RegisterId(18), 0, 5),
                        )
                        .plus([
                            -0.36243686707645817,
                            0.20710678118654752,
                            0.0,
                        ]),
                        y: Field::<__Scene, ::qrt::circuit::format::UFixed<-3, 8>>::new(
                            1,
                            Word {
                                shift: 3,
                                ..Word::unsigned(RegisterId(7), 0, 2)
                            },
                        )
                        .negated()
                        .plus([
                            -0.12304020656595155,
                            0.0,
                            -0.18524193653371793,
                        ]),
                        z: Field::<__Scene, ::qrt::circuit::format::UFixed<-4, 8>>::new(
                            2,
                            Word {
                                shift: 2,
                                ..Word::unsigned(RegisterId(7), 0, 2)
                            },
                        )
                        .plus([
                            -1.0565138854669192,
                            0.0,
                            0.09262096826685896,
                        ]),
                    },
                    distance: Field::<__Scene, ::qrt::circuit::format::UFixed<0, 8>>::new(
                        3,
                        Word::unsigned(RegisterId(10), 0, 8),
                    ),
                    sample_u: Field::<__Scene, ::qrt::circuit::format::UInt<1>>::new(
                        4,
                        Word::unsigned(RegisterId(3), 0, 1),
                    ),
                    sample_v: Field::<__Scene, ::qrt::circuit::format::UInt<1>>::new(
                        5,
                        Word::unsigned(RegisterId(4), 0, 1),
                    ),
                },
                ray1: LitFloorRay1 {
                    direction: Vector {
                        x: Field::<__Scene, ::qrt::circuit::format::Fixed<1, 8>>::new(
                            6,
                            Word::signed(RegisterId(52), 0, 9),
                        ),
                        y: Field::<__Scene, ::qrt::circuit::format::UFixed<0, 8>>::new(
                            7,
                            Word::unsigned(RegisterId(43), 0, 8),
                        ),
                        z: Field::<__Scene, ::qrt::circuit::format::Fixed<1, 8>>::new(
                            8,
                            Word::signed(RegisterId(48), 0, 9),
                        ),
                    },
                    origin: Vector {
                        x: Field::<__Scene, ::qrt::circuit::format::Fixed<-1, 8>>::new(
                            9,
                            Word::signed(RegisterId(35), 0, 7),
                        ),
                        y: Field::<__Scene, ::qrt::circuit::format::Fixed<0, 8>>::new(
                            10,
                            Word::signed(RegisterId(40), 0, 8),
                        )
                        .plus([-0.0947265625, 0.0, 0.0]),
                        z: Field::<__Scene, ::qrt::circuit::format::Fixed<1, 8>>::new(
                            11,
                            Word::signed(RegisterId(41), 0, 9),
                        )
                        .plus([0.123046875, 0.0, 0.0]),
                    },
                    sample_u: Field::<__Scene, ::qrt::circuit::format::UInt<2>>::new(
                        12,
                        Word::unsigned(RegisterId(33), 0, 2),
                    ),
                    sample_v: Field::<__Scene, ::qrt::circuit::format::UInt<2>>::new(
                        13,
                        Word::unsigned(RegisterId(34), 0, 2),
                    ),
                },
            };
        }
        /// Registers by number.
        static R: [Declaration; 98] = [
            Declaration::at(0, "id", Type::UInt, Tag(1), 2),
            Declaration::at(1, "comparator", Type::UInt, Tag(2), 4),
            Declaration::at(2, "flag", Type::Bool, Tag(5), 1),
            Declaration::at(3, "ray0.sample.u", Type::UInt, Tag(0), 1).block(1),
            Declaration::at(4, "ray0.sample.v", Type::UInt, Tag(0), 1).block(1),
            Declaration::at(5, "add5", Type::UFixed { fraction: 8 }, Tag(0), 5).block(3),
            Declaration::at(6, "load6", Type::UFixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(
                7,
                "ray0.direction.y",
                Type::UFixed { fraction: 8 },
                Tag(0),
                2,
            )
            .block(3)
            .scratch(8),
            Declaration::at(8, "table8", Type::Scratch, Tag(3), 2).block(3),
            Declaration::at(9, "add9", Type::UFixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(10, "ray0.distance", Type::UFixed { fraction: 8 }, Tag(0), 8)
                .block(3)
                .range(0, 136)
                .scratch(12),
            Declaration::at(11, "divide11", Type::Bool, Tag(0), 1).block(3),
            Declaration::at(12, "divide12", Type::Scratch, Tag(3), 76).block(3),
            Declaration::at(13, "load13", Type::Fixed { fraction: 8 }, Tag(0), 10).block(3),
            Declaration::at(14, "add14", Type::Fixed { fraction: 8 }, Tag(0), 10).block(3),
            Declaration::at(15, "multiply15", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(3)
                .range(-144, 0)
                .scratch(16),
            Declaration::at(16, "multiply16", Type::Scratch, Tag(3), 105).block(3),
            Declaration::at(17, "load17", Type::Fixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(
                18,
                "ray0.direction.x",
                Type::UFixed { fraction: 8 },
                Tag(0),
                5,
            )
            .block(3)
            .scratch(19),
            Declaration::at(19, "table19", Type::Scratch, Tag(3), 2).block(3),
            Declaration::at(20, "add20", Type::Fixed { fraction: 8 }, Tag(0), 8).block(3),
            Declaration::at(21, "multiply21", Type::Fixed { fraction: 8 }, Tag(0), 7)
                .block(3)
                .range(-50, 49)
                .scratch(22),
            Declaration::at(22, "multiply22", Type::Scratch, Tag(3), 87).block(3),
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
            Declaration::at(35, "ray1.origin.x", Type::Fixed { fraction: 8 }, Tag(0), 7)
                .block(11)
                .range(-50, 50),
            Declaration::at(36, "load36", Type::Fixed { fraction: 8 }, Tag(0), 9).block(12),
            Declaration::at(37, "add37", Type::Fixed { fraction: 8 }, Tag(0), 9).block(12),
            Declaration::at(38, "multiply38", Type::Fixed { fraction: 8 }, Tag(0), 8)
                .block(12)
                .range(-106, 0)
                .scratch(39),
            Declaration::at(39, "multiply39", Type::Scratch, Tag(3), 96).block(12),
            Declaration::at(40, "ray1.origin.y", Type::Fixed { fraction: 8 }, Tag(0), 8)
                .block(12)
                .range(-106, 2),
            Declaration::at(41, "ray1.origin.z", Type::Fixed { fraction: 8 }, Tag(0), 9)
                .block(13)
                .range(-144, 3),
            Declaration::at(42, "add42", Type::UFixed { fraction: 8 }, Tag(0), 8).block(15),
            Declaration::at(
                43,
                "ray1.direction.y",
                Type::UFixed { fraction: 8 },
                Tag(0),
                8,
            )
            .block(15)
            .scratch(44),
            Declaration::at(44, "table44", Type::Scratch, Tag(3), 4).block(15),
            Declaration::at(45, "divide45", Type::UFixed { fraction: 8 }, Tag(0), 9)
                .block(15)
                .range(0, 478)
                .scratch(47),
            Declaration::at(46, "divide46", Type::Bool, Tag(0), 1).block(15),
            Declaration::at(47, "divide47", Type::Scratch, Tag(3), 87).block(15),
            Declaration::at(
                48,
                "ray1.direction.z",
                Type::Fixed { fraction: 8 },
                Tag(0),
                9,
            )
            .block(15)
            .scratch(49),
            Declaration::at(49, "table49", Type::Scratch, Tag(3), 16).block(15),
            Declaration::at(50, "multiply50", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(15)
                .range(-316, 315)
                .scratch(51),
            Declaration::at(51, "multiply51", Type::Scratch, Tag(3), 107).block(15),
            Declaration::at(
                52,
                "ray1.direction.x",
                Type::Fixed { fraction: 8 },
                Tag(0),
                9,
            )
            .block(15),
            Declaration::at(53, "table53", Type::Scratch, Tag(3), 0).block(15),
            Declaration::at(54, "multiply54", Type::Fixed { fraction: 8 }, Tag(0), 10)
                .block(15)
                .range(-316, 315)
                .scratch(55),
            Declaration::at(55, "multiply55", Type::Scratch, Tag(3), 107).block(15),
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
            Declaration::at(86, "colour.r", Type::UFixed { fraction: 8 }, Tag(4), 8).scratch(87),
            Declaration::at(87, "table87", Type::Scratch, Tag(3), 4),
            Declaration::at(88, "table88", Type::UFixed { fraction: 8 }, Tag(0), 8).range(7, 212),
            Declaration::at(89, "table89", Type::Scratch, Tag(3), 0).block(20),
            Declaration::at(90, "colour.g", Type::UFixed { fraction: 8 }, Tag(4), 1),
            Declaration::at(91, "table91", Type::Scratch, Tag(3), 0).block(21),
            Declaration::at(92, "table92", Type::UFixed { fraction: 8 }, Tag(0), 8).range(7, 135),
            Declaration::at(93, "table93", Type::Scratch, Tag(3), 0).block(21),
            Declaration::at(94, "colour.b", Type::UFixed { fraction: 8 }, Tag(4), 6),
            Declaration::at(95, "table95", Type::Scratch, Tag(3), 0).block(22),
            Declaration::at(96, "table96", Type::UFixed { fraction: 8 }, Tag(0), 6).range(7, 58),
            Declaration::at(97, "table97", Type::Scratch, Tag(3), 0).block(22),
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
                component: 0,
                place: Place::Number {
                    word: Word::unsigned(RegisterId(18), 0, 5),
                    negated: false,
                    offset: [-0.36243686707645817, 0.20710678118654752, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 0,
                    name: "direction",
                },
                component: 1,
                place: Place::Number {
                    word: Word {
                        shift: 3,
                        ..Word::unsigned(RegisterId(7), 0, 2)
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
                        ..Word::unsigned(RegisterId(7), 0, 2)
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
                    word: Word::unsigned(RegisterId(10), 0, 8),
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
                    name: "direction",
                },
                component: 0,
                place: Place::Number {
                    word: Word::signed(RegisterId(52), 0, 9),
                    negated: false,
                    offset: [0.0, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "direction",
                },
                component: 1,
                place: Place::Number {
                    word: Word::unsigned(RegisterId(43), 0, 8),
                    negated: false,
                    offset: [0.0, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "direction",
                },
                component: 2,
                place: Place::Number {
                    word: Word::signed(RegisterId(48), 0, 9),
                    negated: false,
                    offset: [0.0, 0.0, 0.0],
                },
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    name: "origin",
                },
                component: 0,
                place: Place::Number {
                    word: Word::signed(RegisterId(35), 0, 7),
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
                    word: Word::signed(RegisterId(40), 0, 8),
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
                    word: Word::signed(RegisterId(41), 0, 9),
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
            order: &[],
            parameters: PARAMETERS,
            style: Style::Wide,
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
                    add5,
                    load6,
                    ray0_direction_y_7,
                    add9,
                    ray0_distance_10,
                    divide11,
                    load13,
                    add14,
                    multiply15,
                    load17,
                    ray0_direction_x_18,
                    add20,
                    multiply21,
                    ray1_sample_u_33,
                    ray1_sample_v_34,
                    ray1_origin_x_35,
                    load36,
                    add37,
                    multiply38,
                    ray1_origin_y_40,
                    ray1_origin_z_41,
                    add42,
                    ray1_direction_y_43,
                    divide45,
                    divide46,
                    ray1_direction_z_48,
                    ray1_direction_x_52,
                    multiply50,
                    multiply54,
                    add56,
                    add57,
                    add58,
                    add59,
                    and60,
                    add61,
                    add62,
                    and63,
                    and64,
                    select66,
                    colour_r_86,
                    table88,
                    colour_g_90,
                    table92,
                    colour_b_94,
                    table96,
                ) = {
                    m.block(BlockId(1));
                    let ray0_sample_u_3 = m.parity(&R[3], id, &[1, 0], Some(0));
                    let ray0_sample_v_4 = m.parity(&R[4], id, &[1, 1], Some(1));
                    m.block(BlockId(3));
                    let add5 = m.add(&R[5], Operand::Constant(16), Operand::Constant(0));
                    let load6 = m.load(&R[6], 2);
                    let [ray0_direction_y_7] =
                        m.table([&R[7]], &[Bit::at(&ray0_sample_v_4, 0)], [T7], 0);
                    let add9 = m.add(
                        &R[9],
                        Operand::unsigned(&load6, 0, 8),
                        Word::unsigned(&ray0_direction_y_7, 0, 2).shifted(3).into(),
                    );
                    let [ray0_distance_10, divide11] = m.divide(
                        &R[10],
                        &R[11],
                        Word::unsigned(&add5, 0, 5).shifted(8),
                        Word::unsigned(&add9, 0, 8),
                    );
                    let load13 = m.load(&R[13], 3);
                    let add14 = m.add(
                        &R[14],
                        Operand::signed(&load13, 0, 10),
                        Word::unsigned(&ray0_direction_y_7, 0, 2).shifted(2).into(),
                    );
                    let multiply15 = m.multiply(
                        &R[15],
                        Word::unsigned(&ray0_distance_10, 0, 8),
                        Word::signed(&add14, 0, 10),
                        8,
                    );
                    let load17 = m.load(&R[17], 4);
                    let [ray0_direction_x_18] =
                        m.table([&R[18]], &[Bit::at(&ray0_sample_u_3, 0)], [T18], 0);
                    let add20 = m.add(
                        &R[20],
                        Operand::signed(&load17, 0, 8),
                        Operand::unsigned(&ray0_direction_x_18, 0, 5),
                    );
                    let multiply21 = m.multiply(
                        &R[21],
                        Word::unsigned(&ray0_distance_10, 0, 8),
                        Word::signed(&add20, 0, 8),
                        8,
                    );
                    m.block(BlockId(6));
                    let ray1_sample_u_33 = m.parity(&R[33], id, &[2, 3], Some(5));
                    let ray1_sample_v_34 = m.parity(&R[34], id, &[2, 3], Some(6));
                    m.block(BlockId(11));
                    let ray1_origin_x_35 = m.subtract(
                        &R[35],
                        Operand::signed(&multiply21, 0, 7),
                        Operand::signed(&multiply21, 6, 1),
                    );
                    m.block(BlockId(12));
                    let load36 = m.load(&R[36], 7);
                    let add37 = m.subtract(
                        &R[37],
                        Operand::signed(&load36, 0, 9),
                        Word::unsigned(&ray0_direction_y_7, 0, 2).shifted(3).into(),
                    );
                    let multiply38 = m.multiply(
                        &R[38],
                        Word::unsigned(&ray0_distance_10, 0, 8),
                        Word::signed(&add37, 0, 9),
                        8,
                    );
                    let ray1_origin_y_40 = m.subtract(
                        &R[40],
                        Operand::signed(&multiply38, 0, 8),
                        Operand::signed(&multiply38, 6, 2),
                    );
                    m.block(BlockId(13));
                    let ray1_origin_z_41 = m.subtract(
                        &R[41],
                        Operand::signed(&multiply15, 0, 9),
                        Operand::signed(&multiply15, 6, 3),
                    );
                    m.block(BlockId(15));
                    let add42 = m.subtract(
                        &R[42],
                        Operand::Constant(64),
                        Operand::signed(&ray1_origin_y_40, 0, 8),
                    );
                    let [ray1_direction_y_43] = m.table(
                        [&R[43]],
                        &[Bit::at(&ray1_sample_u_33, 0), Bit::at(&ray1_sample_u_33, 1)],
                        [T43],
                        0,
                    );
                    let [divide45, divide46] = m.divide(
                        &R[45],
                        &R[46],
                        Word::unsigned(&add42, 0, 8).shifted(8),
                        Word::unsigned(&ray1_direction_y_43, 0, 8),
                    );
                    let [ray1_direction_z_48, ray1_direction_x_52] = m.table(
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
                        Word::signed(&ray1_direction_z_48, 0, 9),
                        8,
                    );
                    let multiply54 = m.multiply(
                        &R[54],
                        Word::unsigned(&divide45, 0, 9),
                        Word::signed(&ray1_direction_x_52, 0, 9),
                        8,
                    );
                    let add56 = m.add(
                        &R[56],
                        Operand::signed(&ray1_origin_z_41, 0, 9),
                        Operand::signed(&multiply50, 0, 10),
                    );
                    let add57 = m.add(
                        &R[57],
                        Operand::signed(&ray1_origin_x_35, 0, 7),
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
                    m.block(BlockId(0));
                    let [
                        colour_r_86,
                        table88,
                        colour_g_90,
                        table92,
                        colour_b_94,
                        table96,
                    ] = m.table(
                        [&R[86], &R[88], &R[90], &R[92], &R[94], &R[96]],
                        &[Bit::at(&select66, 0), Bit::at(&select66, 1)],
                        [T86, T88, T90, T92, T94, T96],
                        0,
                    );
                    (
                        ray0_sample_u_3,
                        ray0_sample_v_4,
                        add5,
                        load6,
                        ray0_direction_y_7,
                        add9,
                        ray0_distance_10,
                        divide11,
                        load13,
                        add14,
                        multiply15,
                        load17,
                        ray0_direction_x_18,
                        add20,
                        multiply21,
                        ray1_sample_u_33,
                        ray1_sample_v_34,
                        ray1_origin_x_35,
                        load36,
                        add37,
                        multiply38,
                        ray1_origin_y_40,
                        ray1_origin_z_41,
                        add42,
                        ray1_direction_y_43,
                        divide45,
                        divide46,
                        ray1_direction_z_48,
                        ray1_direction_x_52,
                        multiply50,
                        multiply54,
                        add56,
                        add57,
                        add58,
                        add59,
                        and60,
                        add61,
                        add62,
                        and63,
                        and64,
                        select66,
                        colour_r_86,
                        table88,
                        colour_g_90,
                        table92,
                        colour_b_94,
                        table96,
                    )
                };

                let fields = &[
                    &ray0_direction_x_18,
                    &ray0_direction_y_7,
                    &ray0_direction_y_7,
                    &ray0_distance_10,
                    &ray0_sample_u_3,
                    &ray0_sample_v_4,
                    &ray1_direction_x_52,
                    &ray1_direction_y_43,
                    &ray1_direction_z_48,
                    &ray1_origin_x_35,
                    &ray1_origin_y_40,
                    &ray1_origin_z_41,
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
                    m.undo([
                        colour_r_86,
                        table88,
                        colour_g_90,
                        table92,
                        colour_b_94,
                        table96,
                    ]);
                    m.block(BlockId(15));
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
                    m.undo([ray1_direction_z_48, ray1_direction_x_52]);
                    m.undo([divide45, divide46]);
                    m.undo([ray1_direction_y_43]);
                    m.undo([add42]);
                    m.block(BlockId(13));
                    m.undo([ray1_origin_z_41]);
                    m.block(BlockId(12));
                    m.undo([ray1_origin_y_40]);
                    m.undo([multiply38]);
                    m.undo([add37]);
                    m.undo([load36]);
                    m.block(BlockId(11));
                    m.undo([ray1_origin_x_35]);
                    m.block(BlockId(6));
                    m.undo([ray1_sample_v_34]);
                    m.undo([ray1_sample_u_33]);
                    m.block(BlockId(3));
                    m.undo([multiply21]);
                    m.undo([add20]);
                    m.undo([ray0_direction_x_18]);
                    m.undo([load17]);
                    m.undo([multiply15]);
                    m.undo([add14]);
                    m.undo([load13]);
                    m.undo([ray0_distance_10, divide11]);
                    m.undo([add9]);
                    m.undo([ray0_direction_y_7]);
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
                let (and60, t98, t100) = {
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
                    let ray0_direction_y_7 = v.table16(&N7, t13);
                    let t15 = ray0_direction_y_7.left(3);
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
                    let ray0_distance_10 = v.ints(255).choose(t25, t24);
                    let load13 = v.ints(word(words, 3, 10, true) as i32);
                    let t28 = ray0_direction_y_7.left(2);
                    let t29 = load13.add(t28);
                    let add14 = t29.left(22).right(22);
                    let t31 = ray0_distance_10.mul(add14).right(8);
                    let multiply15 = t31.left(23).right(23);
                    let load17 = v.ints(word(words, 4, 8, true) as i32);
                    let t34 = v.ints(1).choose(ray0_sample_u_3, v.ints(0));
                    let ray0_direction_x_18 = v.table16(&N18, t34);
                    let t36 = load17.add(ray0_direction_x_18);
                    let add20 = t36.left(24).right(24);
                    let t38 = ray0_distance_10.mul(add20).right(8);
                    let multiply21 = t38.left(25).right(25);
                    let t40 = v.ints(word(words, 5, 2, false) as i32);
                    let t41 = v.table16(&[0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1], t2);
                    let ray1_sample_u_33 = t41.xor(t40);
                    let t43 = v.ints(word(words, 6, 2, false) as i32);
                    let t44 = v.table16(&[0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1, 0, 2, 3, 1], t2);
                    let ray1_sample_v_34 = t44.xor(t43);
                    let t46 = multiply21.right(6);
                    let ray1_origin_x_35 = multiply21.sub(t46);
                    let load36 = v.ints(word(words, 7, 9, true) as i32);
                    let t49 = ray0_direction_y_7.left(3);
                    let t50 = load36.sub(t49);
                    let add37 = t50.left(23).right(23);
                    let t52 = ray0_distance_10.mul(add37).right(8);
                    let multiply38 = t52.left(24).right(24);
                    let t54 = multiply38.right(6);
                    let ray1_origin_y_40 = multiply38.sub(t54);
                    let t56 = multiply15.right(6);
                    let ray1_origin_z_41 = multiply15.sub(t56);
                    let add42 = v.ints(64).sub(ray1_origin_y_40);
                    let ray1_direction_y_43 = v.table16(&N43, ray1_sample_u_33);
                    let t60 = add42.right(1);
                    let t61 = t60.less(ray1_direction_y_43);
                    let t62 = add42.choose(t61, v.ints(0));
                    let t63 = v.quotient_single(t62, ray1_direction_y_43, 8);
                    let t64 = t63.mul(ray1_direction_y_43);
                    let t65 = t62.left(8).sub(t64);
                    let t66 = t65.less(v.ints(0));
                    let t67 = t63.sub(v.ints(1)).choose(t66, t63);
                    let t68 = ray1_direction_y_43.less(v.ints(1));
                    let divide45 = v.ints(511).choose(t68, t67);
                    let t70 = ray1_sample_u_33.has(1);
                    let t71 = v.ints(0).add(v.ints(1));
                    let t72 = t71.choose(t70, v.ints(0));
                    let t73 = ray1_sample_u_33.has(2);
                    let t74 = t72.add(v.ints(2));
                    let t75 = t74.choose(t73, t72);
                    let t76 = ray1_sample_v_34.has(1);
                    let t77 = t75.add(v.ints(4));
                    let t78 = t77.choose(t76, t75);
                    let t79 = ray1_sample_v_34.has(2);
                    let t80 = t78.add(v.ints(8));
                    let t81 = t80.choose(t79, t78);
                    let ray1_direction_z_48 = v.table16(&N48, t81);
                    let ray1_direction_x_52 = v.table16(&N52, t81);
                    let multiply50 = divide45.mul(ray1_direction_z_48).right(8);
                    let multiply54 = divide45.mul(ray1_direction_x_52).right(8);
                    let add56 = ray1_origin_z_41.add(multiply50);
                    let add57 = ray1_origin_x_35.add(multiply54);
                    let add58 = v.ints(177).add(add56);
                    let add59 = v.ints(113).sub(add56);
                    let t90 = add58.less(v.ints(0));
                    let t91 = t90.not();
                    let t92 = add59.less(v.ints(0));
                    let t93 = t92.not();
                    let and60 = t91.and(t93);
                    let add61 = v.ints(145).add(add57);
                    let add62 = v.ints(145).sub(add57);
                    let t97 = add61.less(v.ints(0));
                    let t98 = t97.not();
                    let t99 = add62.less(v.ints(0));
                    let t100 = t99.not();
                    (and60, t98, t100)
                };
                let (t111, t112, t114, t117, t119, t120) = {
                    let and63 = t98.and(t100);
                    let and64 = and60.and(and63);
                    let select66 = v.ints(1).choose(and64, v.ints(2));
                    let colour_r_86 = v.table16(&N86, select66);
                    let table88 = v.table16(&N88, select66);
                    let colour_g_90 = v.marks(2, select66);
                    let table92 = v.table16(&N92, select66);
                    let colour_b_94 = v.table16(&N94, select66);
                    let table96 = v.table16(&N96, select66);
                    let t110 = table88.right(4);
                    let t111 = v.widen(t110);
                    let t112 = v.widen(colour_r_86);
                    let t113 = table92.right(4);
                    let t114 = v.widen(t113);
                    let t115 = v.ints(1).choose(colour_g_90, v.ints(0));
                    let t116 = t115.left(7);
                    let t117 = v.widen(t116);
                    let t118 = table96.right(4);
                    let t119 = v.widen(t118);
                    let t120 = v.widen(colour_b_94);
                    (t111, t112, t114, t117, t119, t120)
                };

                [[t111, t114, t119], [t112, t117, t120]]
            }
        }
    };
};
