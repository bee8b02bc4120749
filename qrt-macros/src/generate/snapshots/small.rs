#[allow(dead_code, reason = "an author asks for some of them only")]
impl Lamp {
    /// The most qubits in use at any time during a call of the oracle of the channel that
    /// has the most Toffolis.
    pub const QUBITS: u64 = 17;
    /// Toffoli gates of a call of the oracle of the channel that has the most.
    pub const TOFFOLI: u64 = 26;
    /// A pixel has `2^PATH_BITS` paths.
    pub const PATH_BITS: u32 = 2;
    /// Qubits of the comparator.
    pub const COMPARATOR_BITS: u32 = 2;
    /// Bits after the point of every number.
    pub const FRACTION_BITS: u32 = 6;
    /// Rays on a path.
    pub const DEPTH: usize = 2;
    /// Columns and rows of the film.
    pub const FILM: [u32; 2] = [2, 2];
    /// By channel (red, green, blue): the proven bound on a path's colour, in radiance.
    pub const SCALE: [f64; 3] = [1.0, 1.0, 1.0];
    /// Operations from a path's id to its three colours.
    pub const OPERATIONS: usize = 8;
}

/// The registers of a ray of [`Lamp`]: points and distances in the scene's units, unit
/// vectors, and the numbers of faces and materials from 1 on.
#[allow(dead_code, reason = "an author reads some of them only")]
pub type LampPathRay = ::qrt::core::oracle::paths::RayRegisters<
    ::qrt::circuit::format::Fixed<7, 2>,
    ::qrt::circuit::format::Fixed<2, 6>,
    ::qrt::circuit::format::UFixed<6, 2>,
    ::qrt::circuit::format::UInt<2>,
    ::qrt::circuit::format::UInt<2>,
>;

/// The registers of a path of [`Lamp`], which predicates read.
#[derive(Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LampPath {
    /// The primary ray, and what it meets.
    pub ray0: LampPathRay,
    /// Ray 1, and what it meets.
    pub ray1: LampPathRay,

    /// The path's radiance.
    pub colour: ::qrt::core::oracle::paths::ColourRegisters<::qrt::circuit::format::UFixed<2, 5>>,
}

impl ::qrt::core::oracle::paths::PathScene for Lamp {
    type Path = LampPath;

    fn scene() -> &'static ::qrt::scene::valid::ValidScene {
        Lamp::scene()
    }

    fn path(inputs: &mut ::qrt::core::oracle::paths::PathInputs<'_>) -> LampPath {
        LampPath {
            ray0: inputs.ray(0),
            ray1: inputs.ray(1),
            colour: inputs.colour(),
        }
    }
}

/// The number of each material of [`Lamp`] that has a name, by name; all of them where
/// several have one.
#[derive(Clone, Copy, Debug)]
#[allow(
    dead_code,
    non_snake_case,
    reason = "an author's names, of which some are read"
)]
pub struct LampMaterials {
    /// `floor`
    pub floor: u32,
    /// `lamp`
    pub lamp: u32,
}

#[allow(dead_code, reason = "an author asks for some of them only")]
impl Lamp {
    /// The number that each material with a name has in the registers of a path.
    pub const MATERIALS: LampMaterials = LampMaterials { floor: 1, lamp: 2 };
}

/// The number of each face of [`Lamp`] that has a name, by name; all of them where
/// several have one.
#[derive(Clone, Copy, Debug)]
#[allow(
    dead_code,
    non_snake_case,
    reason = "an author's names, of which some are read"
)]
pub struct LampFaces {
    /// `ground`
    pub ground: u32,
    /// `sky`
    pub sky: u32,
}

#[allow(dead_code, reason = "an author asks for some of them only")]
impl Lamp {
    /// The number that each face with a name has in the registers of a path.
    pub const FACES: LampFaces = LampFaces { ground: 1, sky: 2 };
}

/// Numbers of the primary ray of [`Lamp`] that are in registers.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LampRay0 {
    /// The cell of the unit square that it samples.
    pub sample_u: ::qrt::core::oracle::compiled::Field<Lamp, ::qrt::circuit::format::UInt<1>>,
}

/// Numbers of ray 1 of [`Lamp`] that are in registers.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LampRay1 {
    /// Where it starts, in the scene's frame as the circuit scales it.
    pub origin_x: ::qrt::core::oracle::compiled::Field<Lamp, ::qrt::circuit::format::UFixed<-4, 6>>,
}

/// Registers of the numbers of a path of [`Lamp`].
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "an author reads some of them only")]
pub struct LampLayout {
    /// Of the primary ray.
    pub ray0: LampRay0,
    /// Of ray 1.
    pub ray1: LampRay1,
}

#[allow(warnings, clippy::all, clippy::pedantic, reason = "written by `qrt!`")]
const _: () = {
    // A name that nothing of what is imported below has.
    type __Scene = Lamp;
    const _: () = {
        use ::qrt::circuit::{
            Bit, BlockId, Declaration, Machine, Multiples, Operand, RegisterId, Style, Tag, Type,
            Word,
        };
        use ::qrt::core::compile::{NamedPlace, PixelWord, Place};
        use ::qrt::core::oracle::Channel;
        use ::qrt::core::oracle::compiled::{
            BlockDeclaration, CompiledOracle, Computed, Field, Outline, Vector,
        };
        use ::qrt::core::tracer::{Named, Quantity};
        use ::qrt::runtime::path_machines::native::{
            Integers, NativeOracle, Truths, Vectors, block, word,
        };
        use ::qrt::scene::sampling::{
            Axis::{U, V},
            Coordinate,
            Square::{Light, Ray},
        };
        impl __Scene {
            /// Registers of the numbers of a path, ray by ray.
            pub const LAYOUT: LampLayout = LampLayout {
                ray0: LampRay0 {
                    sample_u: Field::<__Scene, ::qrt::circuit::format::UInt<1>>::new(
                        0,
                        Word::unsigned(RegisterId(3), 0, 1),
                    ),
                },
                ray1: LampRay1 {
                    origin_x: Field::<__Scene, ::qrt::circuit::format::UFixed<-4, 6>>::new(
                        1,
                        Word {
                            shift: 1,
                            ..Word::unsigned(RegisterId(33), 0, 1)
                        },
                    )
                    .plus([-0.03640548888044781, 0.048540651840597075, 0.0]),
                },
            };
        }
        /// Registers by number.
        static R: [Declaration; 35] = [
            Declaration::at(0, "id", Type::UInt, Tag(1), 2),
            Declaration::at(1, "comparator", Type::UInt, Tag(2), 2),
            Declaration::at(2, "flag", Type::Bool, Tag(5), 1),
            Declaration::at(3, "ray0.sample.u", Type::UInt, Tag(0), 1).block(1),
            Declaration::at(4, "parity4", Type::UInt, Tag(0), 1).block(1),
            Declaration::at(5, "load5", Type::Fixed { fraction: 6 }, Tag(0), 3).block(2),
            Declaration::at(6, "table6", Type::UFixed { fraction: 6 }, Tag(0), 1)
                .block(2)
                .scratch(7),
            Declaration::at(7, "table7", Type::Scratch, Tag(3), 0).block(2),
            Declaration::at(8, "add8", Type::Fixed { fraction: 6 }, Tag(0), 4).block(2),
            Declaration::at(9, "select9", Type::UInt, Tag(0), 2).block(2),
            Declaration::at(10, "parity10", Type::UInt, Tag(0), 2).block(5),
            Declaration::at(11, "parity11", Type::UInt, Tag(0), 1).block(5),
            Declaration::at(12, "add12", Type::UFixed { fraction: 6 }, Tag(0), 4).block(14),
            Declaration::at(13, "table13", Type::UFixed { fraction: 6 }, Tag(0), 6).block(14),
            Declaration::at(14, "table14", Type::Scratch, Tag(3), 0).block(14),
            Declaration::at(15, "divide15", Type::UFixed { fraction: 6 }, Tag(0), 7)
                .block(14)
                .range(0, 33),
            Declaration::at(16, "divide16", Type::Bool, Tag(0), 1).block(14),
            Declaration::at(17, "divide17", Type::Scratch, Tag(3), 0).block(14),
            Declaration::at(18, "table18", Type::Fixed { fraction: 6 }, Tag(0), 7).block(14),
            Declaration::at(19, "table19", Type::Scratch, Tag(3), 0).block(14),
            Declaration::at(20, "multiply20", Type::Fixed { fraction: 6 }, Tag(0), 6)
                .block(14)
                .range(-31, 30),
            Declaration::at(21, "multiply21", Type::Scratch, Tag(3), 0).block(14),
            Declaration::at(22, "table22", Type::UFixed { fraction: 6 }, Tag(0), 1).block(14),
            Declaration::at(23, "table23", Type::Scratch, Tag(3), 0).block(14),
            Declaration::at(24, "add24", Type::Fixed { fraction: 6 }, Tag(0), 7)
                .block(14)
                .range(-33, 30),
            Declaration::at(25, "load25", Type::Fixed { fraction: 6 }, Tag(0), 3).block(14),
            Declaration::at(26, "add26", Type::Fixed { fraction: 6 }, Tag(0), 4).block(14),
            Declaration::at(27, "select27", Type::UFixed { fraction: 6 }, Tag(0), 7)
                .block(14)
                .range(0, 127),
            Declaration::at(28, "select28", Type::UInt, Tag(0), 2).block(14),
            Declaration::at(29, "colour.b", Type::UFixed { fraction: 6 }, Tag(4), 1)
                .block(18)
                .scratch(30),
            Declaration::at(30, "table30", Type::Scratch, Tag(3), 0).block(18),
            Declaration::at(31, "table31", Type::UFixed { fraction: 6 }, Tag(0), 6)
                .block(18)
                .range(7, 39),
            Declaration::at(32, "table32", Type::Scratch, Tag(3), 0).block(18),
            Declaration::at(33, "ray1.origin.x", Type::UFixed { fraction: 6 }, Tag(0), 1),
            Declaration::at(34, "select28'", Type::UInt, Tag(0), 2),
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
                parent: Some(BlockId(5)),
                name: "sample",
                tag: Tag(288230384741646336),
            },
            BlockDeclaration {
                parent: Some(BlockId(5)),
                name: "x",
                tag: Tag(18230571300185702400),
            },
            BlockDeclaration {
                parent: Some(BlockId(5)),
                name: "y",
                tag: Tag(18230571300185702401),
            },
            BlockDeclaration {
                parent: Some(BlockId(5)),
                name: "z",
                tag: Tag(18230571300185702402),
            },
            BlockDeclaration {
                parent: Some(BlockId(5)),
                name: "x",
                tag: Tag(18230571300185702400),
            },
            BlockDeclaration {
                parent: Some(BlockId(5)),
                name: "y",
                tag: Tag(18230571300185702401),
            },
            BlockDeclaration {
                parent: Some(BlockId(5)),
                name: "z",
                tag: Tag(18230571300185702402),
            },
            BlockDeclaration {
                parent: Some(BlockId(0)),
                name: "find_intersection",
                tag: Tag(144115196665790464),
            },
            BlockDeclaration {
                parent: Some(BlockId(13)),
                name: "plane 1",
                tag: Tag(18374686488261558273),
            },
            BlockDeclaration {
                parent: Some(BlockId(13)),
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
        static T6: &[i64] = &[0, 1];
        static T29: &[i64] = &[0, 1, 0, 0];
        static T31: &[i64] = &[7, 39, 7, 7];
        const PARAMETERS: &[PixelWord] = &[
            PixelWord::Shift {
                coordinate: Coordinate {
                    depth: 0,
                    square: Ray,
                    axis: U,
                },
                bits: 1,
            },
            PixelWord::Shift {
                coordinate: Coordinate {
                    depth: 0,
                    square: Ray,
                    axis: V,
                },
                bits: 1,
            },
            PixelWord::Affine {
                constant: -0.02320752147247411,
                along: [0.05177669529663688, 0.0],
                fraction: 6,
                width: 3,
            },
            PixelWord::Shift {
                coordinate: Coordinate {
                    depth: 1,
                    square: Ray,
                    axis: U,
                },
                bits: 2,
            },
            PixelWord::Shift {
                coordinate: Coordinate {
                    depth: 1,
                    square: Ray,
                    axis: V,
                },
                bits: 1,
            },
            PixelWord::Affine {
                constant: -0.02078048888044426,
                along: [0.048540651840597075, 0.0],
                fraction: 6,
                width: 3,
            },
        ];
        const CHANNELS: &[Channel] = &[
            Channel {
                number: 0,
                colour: Operand::Word(Word {
                    shift: 5,
                    ..Word::unsigned(RegisterId(29), 0, 1)
                }),
                count: Operand::Word(Word::unsigned(RegisterId(31), 4, 2)),
                scale: 1.0,
            },
            Channel {
                number: 1,
                colour: Operand::Word(Word {
                    shift: 5,
                    ..Word::unsigned(RegisterId(29), 0, 1)
                }),
                count: Operand::Word(Word::unsigned(RegisterId(31), 4, 2)),
                scale: 1.0,
            },
            Channel {
                number: 2,
                colour: Operand::Word(Word {
                    shift: 5,
                    ..Word::unsigned(RegisterId(29), 0, 1)
                }),
                count: Operand::Word(Word::unsigned(RegisterId(31), 4, 2)),
                scale: 1.0,
            },
        ];
        const PLACES: &[NamedPlace] = &[
            NamedPlace {
                name: Named {
                    depth: 0,
                    quantity: Quantity::Sample,
                },
                component: 0,
                place: Place::Index(Word::unsigned(RegisterId(3), 0, 1)),
            },
            NamedPlace {
                name: Named {
                    depth: 1,
                    quantity: Quantity::Origin,
                },
                component: 0,
                place: Place::Number {
                    word: Word {
                        shift: 1,
                        ..Word::unsigned(RegisterId(33), 0, 1)
                    },
                    negated: false,
                    offset: [-0.03640548888044781, 0.048540651840597075, 0.0],
                },
            },
        ];
        static OUTLINE: Outline = Outline {
            registers: &R,
            blocks: BLOCKS,
            order: &[
                RegisterId(3),
                RegisterId(6),
                RegisterId(25),
                RegisterId(26),
                RegisterId(28),
                RegisterId(29),
                RegisterId(33),
                RegisterId(34),
            ],
            parameters: PARAMETERS,
            style: Style::InPlace,
            channels: CHANNELS,
            id: RegisterId(0),
            comparator: RegisterId(1),
            flag: RegisterId(2),
            fraction: 6,
            sharing: [30, 9],
            places: PLACES,
        };
        impl CompiledOracle for __Scene {
            const OUTLINE: &'static Outline = &OUTLINE;

            fn scene() -> &'static ::qrt::scene::valid::ValidScene {
                __Scene::scene()
            }

            #[inline(always)]
            fn within<M: Machine, T>(
                m: &mut M,
                id: &M::Register,
                apply: impl FnOnce(&mut M, Computed<'_, Self, M::Register>) -> T,
            ) -> T {
                let (ray0_sample_u_3, ray1_origin_x_33, select28__34, colour_b_29, table31) =
                    (|| {
                        m.block(BlockId(1));
                        let ray0_sample_u_3 = m.parity(&R[3], id, &[1, 0], Some(0));
                        m.block(BlockId(2));
                        let [table6] = m.table([&R[6]], &[Bit::at(&ray0_sample_u_3, 0)], [T6], 0);
                        m.block(BlockId(0));
                        let ray1_origin_x_33 = m.copy(&R[33], Word::unsigned(&table6, 0, 1));
                        m.block(BlockId(2));
                        m.undo([table6]);
                        m.block(BlockId(14));
                        let load25 = m.load(&R[25], 5);
                        let add26 = m.add(
                            &R[26],
                            Operand::signed(&load25, 0, 3),
                            Word::unsigned(&ray1_origin_x_33, 0, 1).shifted(1).into(),
                        );
                        let select28 = m.select(
                            &R[28],
                            Bit::at(&add26, 3).inverted(),
                            Operand::Constant(1),
                            Operand::Constant(2),
                        );
                        m.undo([add26]);
                        m.undo([load25]);
                        m.block(BlockId(0));
                        let select28__34 = m.copy(&R[34], Word::unsigned(&select28, 0, 2));
                        m.block(BlockId(14));
                        let load25 = m.load(&R[25], 5);
                        let add26 = m.add(
                            &R[26],
                            Operand::signed(&load25, 0, 3),
                            Word::unsigned(&ray1_origin_x_33, 0, 1).shifted(1).into(),
                        );
                        m.undo([select28]);
                        m.undo([add26]);
                        m.undo([load25]);
                        m.block(BlockId(18));
                        let [colour_b_29, table31] = m.table(
                            [&R[29], &R[31]],
                            &[Bit::at(&select28__34, 0), Bit::at(&select28__34, 1)],
                            [T29, T31],
                            0,
                        );
                        (
                            ray0_sample_u_3,
                            ray1_origin_x_33,
                            select28__34,
                            colour_b_29,
                            table31,
                        )
                    })();

                let fields = &[&ray0_sample_u_3, &ray1_origin_x_33];
                let channels = [
                    [
                        Operand::unsigned(&table31, 4, 2),
                        Word::unsigned(&colour_b_29, 0, 1).shifted(5).into(),
                    ],
                    [
                        Operand::unsigned(&table31, 4, 2),
                        Word::unsigned(&colour_b_29, 0, 1).shifted(5).into(),
                    ],
                    [
                        Operand::unsigned(&table31, 4, 2),
                        Word::unsigned(&colour_b_29, 0, 1).shifted(5).into(),
                    ],
                ];
                let applied = apply(m, Computed::new(fields, channels));
                let () = (|| {
                    m.undo([colour_b_29, table31]);
                    m.block(BlockId(14));
                    let load25 = m.load(&R[25], 5);
                    let add26 = m.add(
                        &R[26],
                        Operand::signed(&load25, 0, 3),
                        Word::unsigned(&ray1_origin_x_33, 0, 1).shifted(1).into(),
                    );
                    let select28 = m.select(
                        &R[28],
                        Bit::at(&add26, 3).inverted(),
                        Operand::Constant(1),
                        Operand::Constant(2),
                    );
                    m.undo([add26]);
                    m.undo([load25]);
                    m.block(BlockId(0));
                    m.undo([select28__34]);
                    m.block(BlockId(14));
                    let load25 = m.load(&R[25], 5);
                    let add26 = m.add(
                        &R[26],
                        Operand::signed(&load25, 0, 3),
                        Word::unsigned(&ray1_origin_x_33, 0, 1).shifted(1).into(),
                    );
                    m.undo([select28]);
                    m.undo([add26]);
                    m.undo([load25]);
                    m.block(BlockId(2));
                    let [table6] = m.table([&R[6]], &[Bit::at(&ray0_sample_u_3, 0)], [T6], 0);
                    m.block(BlockId(0));
                    m.undo([ray1_origin_x_33]);
                    m.block(BlockId(2));
                    m.undo([table6]);
                    m.block(BlockId(1));
                    m.undo([ray0_sample_u_3]);
                    ()
                })();

                applied
            }
        }
        #[cfg(any(not(debug_assertions), test))]
        const _: () = {
            static N31: [i32; 16] = [7, 39, 7, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

            impl NativeOracle for __Scene {
                #[inline(always)]
                fn native<V: Vectors>(v: V, words: &[u64], ids: V::Longs) -> [[V::Longs; 3]; 2] {
                    let (t21, t24, t26, t29, t31, t34) = block(
                        #[cfg_attr(not(debug_assertions), inline(always))]
                        || {
                            let t1 = ids;
                            let t2 = v.narrow(t1);
                            let t3 = v.ints(word(words, 0, 1, false) as i32);
                            let t4 =
                                v.table16(&[0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1], t2);
                            let t5 = t4.xor(t3);
                            let ray0_sample_u_3 = t5.has(1);
                            let t7 = v.ints(1).choose(ray0_sample_u_3, v.ints(0));
                            let table6 = v.marks(2, t7);
                            let t9 = v.ints(1).choose(table6, v.ints(0));
                            let ray1_origin_x_33 = t9.has(1);
                            let load25 = v.ints(word(words, 5, 3, true) as i32);
                            let t12 = v.ints(1).choose(ray1_origin_x_33, v.ints(0));
                            let t13 = t12.left(1);
                            let add26 = load25.add(t13);
                            let t15 = add26.less(v.ints(0));
                            let t16 = t15.not();
                            let select28 = v.ints(1).choose(t16, v.ints(2));
                            let colour_b_29 = v.marks(2, select28);
                            let table31 = v.table16(&N31, select28);
                            let t20 = table31.right(4);
                            let t21 = v.widen(t20);
                            let t22 = v.ints(1).choose(colour_b_29, v.ints(0));
                            let t23 = t22.left(5);
                            let t24 = v.widen(t23);
                            let t25 = table31.right(4);
                            let t26 = v.widen(t25);
                            let t27 = v.ints(1).choose(colour_b_29, v.ints(0));
                            let t28 = t27.left(5);
                            let t29 = v.widen(t28);
                            let t30 = table31.right(4);
                            let t31 = v.widen(t30);
                            let t32 = v.ints(1).choose(colour_b_29, v.ints(0));
                            let t33 = t32.left(5);
                            let t34 = v.widen(t33);
                            (t21, t24, t26, t29, t31, t34)
                        },
                    );

                    [[t21, t26, t31], [t24, t29, t34]]
                }
            }
        };
        #[cfg(not(any(not(debug_assertions), test)))]
        impl NativeOracle for __Scene {
            const WRITTEN: bool = false;
            fn native<V: Vectors>(_: V, _: &[u64], _: V::Longs) -> [[V::Longs; 3]; 2] {
                ::core::unreachable!("no native code without optimisation")
            }
        }
    };
};
