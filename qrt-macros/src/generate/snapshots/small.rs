const _: () = {
    #[allow(dead_code, reason = "an author asks for some of them only")]
    impl Lamp {
        /// The most qubits in use at any time during a call of the oracle of the channel that
        /// has the most Toffolis.
        pub const QUBITS: ::core::primitive::u64 = 17;
        /// Toffoli gates of a call of the oracle of the channel that has the most.
        pub const TOFFOLI: ::core::primitive::u64 = 26;
        /// A pixel has `2^PATH_BITS` paths.
        pub const PATH_BITS: ::core::primitive::u32 = 2;
        /// Qubits of the comparator.
        pub const COMPARATOR_BITS: ::core::primitive::u32 = 2;
        /// Bits after the point of every number.
        pub const FRACTION_BITS: ::core::primitive::u32 = 6;
        /// Rays on a path.
        pub const DEPTH: ::core::primitive::usize = 2;
        /// Columns and rows of the film.
        pub const FILM: [::core::primitive::u32; 2] = [2, 2];
        /// By channel (red, green, blue): the proven bound on a path's colour, in radiance.
        pub const SCALE: [::core::primitive::f64; 3] = [1.0, 1.0, 1.0];
        /// Operations from a path's id to its three colours.
        pub const OPERATIONS: ::core::primitive::usize = 8;
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
    #[::core::prelude::v1::derive(::core::fmt::Debug)]
    #[allow(
        non_camel_case_types,
        reason = "messages show a name of this case without its module"
    )]
    #[allow(dead_code, reason = "an author reads some of them only")]
    pub struct PATH {
        /// The primary ray, and what it meets.
        pub ray0: LampPathRay,
        /// Ray 1, and what it meets.
        pub ray1: LampPathRay,

        /// The path's radiance.
        pub colour:
            ::qrt::core::oracle::paths::ColourRegisters<::qrt::circuit::format::UFixed<2, 5>>,
    }

    impl ::qrt::core::oracle::paths::PathScene for Lamp {
        type Path = PATH;

        fn scene() -> &'static ::qrt::scene::valid::ValidScene {
            Lamp::scene()
        }

        fn path(inputs: &mut ::qrt::core::oracle::paths::PathInputs<'_>) -> PATH {
            PATH {
                ray0: inputs.ray(0),
                ray1: inputs.ray(1),
                colour: inputs.colour(),
            }
        }
    }
    /// The number of each material of [`Lamp`] that has a name, by name; all of them where
    /// several have one.
    #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
    #[allow(
        non_camel_case_types,
        reason = "messages show a name of this case without its module"
    )]
    #[allow(
        dead_code,
        non_snake_case,
        reason = "an author's names, of which some are read"
    )]
    pub struct MATERIALS {
        /// `floor`
        pub floor: ::core::primitive::u32,
        /// `lamp`
        pub lamp: ::core::primitive::u32,
    }

    #[allow(dead_code, reason = "an author asks for some of them only")]
    impl Lamp {
        /// The number that each material with a name has in the registers of a path.
        pub const MATERIALS: MATERIALS = MATERIALS { floor: 1, lamp: 2 };
    }
    /// The number of each face of [`Lamp`] that has a name, by name; all of them where
    /// several have one.
    #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
    #[allow(
        non_camel_case_types,
        reason = "messages show a name of this case without its module"
    )]
    #[allow(
        dead_code,
        non_snake_case,
        reason = "an author's names, of which some are read"
    )]
    pub struct FACES {
        /// `ground`
        pub ground: ::core::primitive::u32,
        /// `sky`
        pub sky: ::core::primitive::u32,
    }

    #[allow(dead_code, reason = "an author asks for some of them only")]
    impl Lamp {
        /// The number that each face with a name has in the registers of a path.
        pub const FACES: FACES = FACES { ground: 1, sky: 2 };
    }
    /// Numbers of the primary ray of [`Lamp`] that are in registers.
    #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
    #[allow(dead_code, reason = "an author reads some of them only")]
    pub struct Ray0 {
        /// Cell of the unit square that samples the direction.
        pub sample_u: ::qrt::core::oracle::compiled::Field<Lamp, ::qrt::circuit::format::UInt<1>>,
    }
    /// Numbers of ray 1 of [`Lamp`] that are in registers.
    #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
    #[allow(dead_code, reason = "an author reads some of them only")]
    pub struct Ray1 {
        /// Start of the ray, in the scene's frame as the circuit scales it.
        pub origin_x:
            ::qrt::core::oracle::compiled::Field<Lamp, ::qrt::circuit::format::UFixed<-4, 6>>,
    }
    /// Registers of the numbers of a path of [`Lamp`].
    #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
    #[allow(
        non_camel_case_types,
        reason = "messages show the name that an author writes"
    )]
    #[allow(dead_code, reason = "an author reads some of them only")]
    pub struct LAYOUT {
        /// Of the primary ray.
        pub ray0: Ray0,
        /// Of ray 1.
        pub ray1: Ray1,
    }

    #[allow(warnings, clippy::all, clippy::pedantic, reason = "written by `qrt!`")]
    const _: () = {
        // A name that nothing of what is imported below has.
        type __Scene = Lamp;
        const _: () = {
            // The author's own items may have any of these names.
            use ::core::clone::Clone;
            use ::core::convert::{From, Into};
            use ::core::default::Default;
            use ::core::iter::{IntoIterator, Iterator};
            use ::core::marker::{Copy, Send, Sized, Sync};
            use ::core::ops::{Drop, Fn, FnMut, FnOnce};
            use ::core::option::Option::{self, None, Some};
            use ::core::primitive::{
                bool, f32, f64, i8, i16, i32, i64, i128, str, u8, u16, u32, u64, u128, usize,
            };
            use ::core::result::Result::{self, Err, Ok};
            use ::qrt::circuit::{
                Bit, BlockId, Declaration, Machine, Multiples, Operand, RegisterId, Style, Tag,
                Type, When, Word,
            };
            use ::qrt::core::compile::{NamedPlace, PixelWord, ValuePlace};
            use ::qrt::core::oracle::Channel;
            use ::qrt::core::oracle::compiled::{
                BlockDeclaration, CompiledOracle, Computed, Field, Outline, Vector,
            };
            use ::qrt::scene::sampling::{
                Axis::{U, V},
                Coordinate,
                Square::{Light, Ray},
            };
            use ::qrt::tracer::{Named, Quantity};
            impl __Scene {
                /// Registers of the numbers of a path, ray by ray.
                pub const LAYOUT: LAYOUT = LAYOUT {
                    ray0: Ray0 {
                        sample_u: Field::<__Scene, ::qrt::circuit::format::UInt<1>>::new(
                            0,
                            Word::unsigned(RegisterId(3), 0, 1),
                        ),
                    },
                    ray1: Ray1 {
                        origin_x: Field::<__Scene, ::qrt::circuit::format::UFixed<-4, 6>>::new(
                            1,
                            Word {
                                shift: 1,
                                ..Word::unsigned(RegisterId(27), 0, 1)
                            },
                        )
                        .plus([
                            -0.03640548888044781,
                            0.048540651840597075,
                            0.0,
                        ]),
                    },
                };
            }
            /// Registers by number.
            static R: [Declaration; 29] = [
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
                Declaration::at(12, "table12", Type::Fixed { fraction: 6 }, Tag(0), 7).block(14),
                Declaration::at(13, "table13", Type::Scratch, Tag(3), 0).block(14),
                Declaration::at(14, "table14", Type::UFixed { fraction: 6 }, Tag(0), 1).block(14),
                Declaration::at(15, "table15", Type::Scratch, Tag(3), 0).block(14),
                Declaration::at(16, "add16", Type::Fixed { fraction: 6 }, Tag(0), 7)
                    .block(14)
                    .range(-34, 32),
                Declaration::at(17, "load17", Type::Fixed { fraction: 6 }, Tag(0), 3).block(14),
                Declaration::at(18, "add18", Type::Fixed { fraction: 6 }, Tag(0), 4).block(14),
                Declaration::at(19, "table19", Type::UFixed { fraction: 6 }, Tag(0), 6).block(14),
                Declaration::at(20, "table20", Type::Scratch, Tag(3), 0).block(14),
                Declaration::at(21, "select21", Type::UFixed { fraction: 6 }, Tag(0), 7)
                    .block(14)
                    .range(13, 127),
                Declaration::at(22, "select22", Type::UInt, Tag(0), 2).block(14),
                Declaration::at(23, "colour.b", Type::UFixed { fraction: 6 }, Tag(4), 1)
                    .block(18)
                    .scratch(24),
                Declaration::at(24, "table24", Type::Scratch, Tag(3), 0).block(18),
                Declaration::at(25, "table25", Type::UFixed { fraction: 6 }, Tag(0), 6)
                    .block(18)
                    .range(7, 39),
                Declaration::at(26, "table26", Type::Scratch, Tag(3), 0).block(18),
                Declaration::at(27, "ray1.origin.x", Type::UFixed { fraction: 6 }, Tag(0), 1),
                Declaration::at(28, "select22'", Type::UInt, Tag(0), 2),
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
            static T23: &[i64] = &[0, 1, 0, 0];
            static T25: &[i64] = &[7, 39, 7, 7];
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
                        ..Word::unsigned(RegisterId(23), 0, 1)
                    }),
                    count: Operand::Word(Word::unsigned(RegisterId(25), 4, 2)),
                    scale: 1.0,
                },
                Channel {
                    number: 1,
                    colour: Operand::Word(Word {
                        shift: 5,
                        ..Word::unsigned(RegisterId(23), 0, 1)
                    }),
                    count: Operand::Word(Word::unsigned(RegisterId(25), 4, 2)),
                    scale: 1.0,
                },
                Channel {
                    number: 2,
                    colour: Operand::Word(Word {
                        shift: 5,
                        ..Word::unsigned(RegisterId(23), 0, 1)
                    }),
                    count: Operand::Word(Word::unsigned(RegisterId(25), 4, 2)),
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
                    place: ValuePlace::Index(Word::unsigned(RegisterId(3), 0, 1)),
                },
                NamedPlace {
                    name: Named {
                        depth: 1,
                        quantity: Quantity::Origin,
                    },
                    component: 0,
                    place: ValuePlace::Number {
                        word: Word {
                            shift: 1,
                            ..Word::unsigned(RegisterId(27), 0, 1)
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
                    RegisterId(17),
                    RegisterId(18),
                    RegisterId(22),
                    RegisterId(23),
                    RegisterId(27),
                    RegisterId(28),
                ],
                parameters: PARAMETERS,
                style: Style::InPlace,
                channels: CHANNELS,
                id: RegisterId(0),
                comparator: RegisterId(1),
                flag: RegisterId(2),
                fraction: 6,
                sharing: [25, 7],
                places: PLACES,
            };
            impl CompiledOracle for __Scene {
                const OUTLINE: &'static Outline = &OUTLINE;

                fn scene() -> &'static ::qrt::scene::valid::ValidScene {
                    __Scene::scene()
                }

                #[inline(always)]
                fn within<M: Machine, T>(
                    __m: &mut M,
                    __id: &M::Register,
                    __apply: impl FnOnce(&mut M, Computed<'_, Self, M::Register>) -> T,
                ) -> T {
                    let (ray0_sample_u_3, ray1_origin_x_27, select22__28, colour_b_23, table25) =
                        (|| {
                            __m.block(BlockId(1));
                            let ray0_sample_u_3 = __m.parity(&R[3], __id, &[1, 0], Some(0));
                            __m.block(BlockId(2));
                            let [table6] =
                                __m.table([&R[6]], &[Bit::at(&ray0_sample_u_3, 0)], [T6], 0);
                            __m.block(BlockId(0));
                            let ray1_origin_x_27 = __m.copy(&R[27], Word::unsigned(&table6, 0, 1));
                            __m.block(BlockId(2));
                            __m.undo([table6]);
                            __m.block(BlockId(14));
                            let load17 = __m.load(&R[17], 5);
                            let add18 = __m.add(
                                &R[18],
                                Operand::signed(&load17, 0, 3),
                                Word::unsigned(&ray1_origin_x_27, 0, 1).shifted(1).into(),
                            );
                            let select22 = __m.select(
                                &R[22],
                                Bit::at(&add18, 3).inverted(),
                                Operand::Constant(1),
                                Operand::Constant(2),
                            );
                            __m.undo([add18]);
                            __m.undo([load17]);
                            __m.block(BlockId(0));
                            let select22__28 = __m.copy(&R[28], Word::unsigned(&select22, 0, 2));
                            __m.block(BlockId(14));
                            let load17 = __m.load(&R[17], 5);
                            let add18 = __m.add(
                                &R[18],
                                Operand::signed(&load17, 0, 3),
                                Word::unsigned(&ray1_origin_x_27, 0, 1).shifted(1).into(),
                            );
                            __m.undo([select22]);
                            __m.undo([add18]);
                            __m.undo([load17]);
                            __m.block(BlockId(18));
                            let [colour_b_23, table25] = __m.table(
                                [&R[23], &R[25]],
                                &[Bit::at(&select22__28, 0), Bit::at(&select22__28, 1)],
                                [T23, T25],
                                0,
                            );
                            (
                                ray0_sample_u_3,
                                ray1_origin_x_27,
                                select22__28,
                                colour_b_23,
                                table25,
                            )
                        })();

                    let __fields = &[&ray0_sample_u_3, &ray1_origin_x_27];
                    let __channels = [
                        [
                            Operand::unsigned(&table25, 4, 2),
                            Word::unsigned(&colour_b_23, 0, 1).shifted(5).into(),
                        ],
                        [
                            Operand::unsigned(&table25, 4, 2),
                            Word::unsigned(&colour_b_23, 0, 1).shifted(5).into(),
                        ],
                        [
                            Operand::unsigned(&table25, 4, 2),
                            Word::unsigned(&colour_b_23, 0, 1).shifted(5).into(),
                        ],
                    ];
                    let __applied = __apply(__m, Computed::new(__fields, __channels));
                    let () = (|| {
                        __m.undo([colour_b_23, table25]);
                        __m.block(BlockId(14));
                        let load17 = __m.load(&R[17], 5);
                        let add18 = __m.add(
                            &R[18],
                            Operand::signed(&load17, 0, 3),
                            Word::unsigned(&ray1_origin_x_27, 0, 1).shifted(1).into(),
                        );
                        let select22 = __m.select(
                            &R[22],
                            Bit::at(&add18, 3).inverted(),
                            Operand::Constant(1),
                            Operand::Constant(2),
                        );
                        __m.undo([add18]);
                        __m.undo([load17]);
                        __m.block(BlockId(0));
                        __m.undo([select22__28]);
                        __m.block(BlockId(14));
                        let load17 = __m.load(&R[17], 5);
                        let add18 = __m.add(
                            &R[18],
                            Operand::signed(&load17, 0, 3),
                            Word::unsigned(&ray1_origin_x_27, 0, 1).shifted(1).into(),
                        );
                        __m.undo([select22]);
                        __m.undo([add18]);
                        __m.undo([load17]);
                        __m.block(BlockId(2));
                        let [table6] = __m.table([&R[6]], &[Bit::at(&ray0_sample_u_3, 0)], [T6], 0);
                        __m.block(BlockId(0));
                        __m.undo([ray1_origin_x_27]);
                        __m.block(BlockId(2));
                        __m.undo([table6]);
                        __m.block(BlockId(1));
                        __m.undo([ray0_sample_u_3]);
                        ()
                    })();

                    __applied
                }
            }
        };
    };
};
