//! Problems with the paths of a scene, and with the circuit that it compiles to.

use super::grouped;

problems! {
    /// Problems with paths, comparators and accuracy.
    Sampling {
        PrimaryMap = PRIMARY_MAP "the primary ray has no map: it samples the pixel square"
            help "remove it; the maps of reflected rays start with the second entry";
        PrimaryLight = PRIMARY_LIGHT "the primary ray leaves no surface that a lamp could light"
            help "remove it; the second entry's ray leaves the first surface";
        NoLens = NO_LENS "the camera has no lens on which a point is sampled"
            help "remove it, or give a perspective camera a `lens`";
        ReflectedLens = NO_LENS "only the primary ray starts on the lens"
            help "remove it; the lens belongs to the first entry";
        TooManyDepths { dimensions: usize, most: usize, lit: bool } = TOO_MANY_DIMENSIONS
            "the depths need {dimensions} dimensions: the net has {most}"
            help { Some(format!(
                "use fewer depths, {}or `product-lattice`",
                if *lit { "`light: none` for some, " } else { "" }
            )) };
        TooManyRays { rays: usize, most: usize } = TOO_MANY_DIMENSIONS
            "the depths are {rays} rays: a path has {most} at most"
            help "use fewer depths";
        FewLightBits { lamps: usize, bits: u32, needed: u32 } = FEW_LIGHT_BITS
            { format!("there are {lamps} lamps, and {bits} bits choose among {}", 1_u64 << bits) }
            help { Some(if *needed > 16 {
                "more than 65,536 lamps cannot be sampled: write `light: none`".to_owned()
            } else {
                format!("write {needed} bits or more here")
            }) };
        LightUnbounded { surface: String } = LIGHT_UNBOUNDED
            "no bound of next-event estimation can be shown: a lamp may touch a surface of `{surface}`"
            help "write `mis`, whose weights never pass 1, or `auto`";
        NoReceiver = LIGHT_UNUSED
            "no surface reflects to more than single directions and tells how densely: none can \
             sample a lamp" help "remove it, or write `lights: none`";
        NoPoints { cause: &'static str } = LIGHT_UNUSED
            "`lights` changes nothing: {cause}" help "write `light: [8, 8]` for a ray that leaves a \
             surface, or `lights: none`";
        TooManyIds { path: u32, comparator: u32, most: u32 } = TOO_MANY_IDS
            { format!("{path} path bits and {comparator} comparator bits make 2^{} indices: at most \
                2^{most} fit", path.saturating_add(*comparator)) }
            help "use fewer of either" also "with these";
        TooManyPaths { sum: u32, most: u32 } = TOO_MANY_IDS
            "the bits add up to {sum}: a lattice of at most 2^{most} paths"
            help "use fewer bits; a bit more in each of six coordinates is 64 times the paths";
        NotTheSum { path: u32, sum: u32 } = PATH_BITS_SUM
            "path_bits is {path}, but the bits add up to {sum}"
            help "under `product-lattice` leave `path_bits` out, or change the bits"
            also "these bits";
        BesideAccuracy { key: &'static str } = ACCURACY_CONFLICT
            "`accuracy` chooses `{key}`, so that both cannot be given"
            help "keep one of the two" also "the accuracy asked for";
        NoStrata { strata: u32, estimator: &'static str, counting: &'static str } = STRATA
            "{strata} strata, and the estimator `{estimator}` counts the whole comparator at once"
            help "use `strata: auto` or 1, or `estimator: {counting}`" also "this estimator";
        TooManyStrata { strata: u32, bits: u32, most: u32 } = STRATA
            "{strata} strata, and a comparator of {bits} bits has at most {most}"
            help "use fewer, or more `comparator.bits`" also "these bits";
        NeverStops { estimator: &'static str, stopping: &'static str } = NEVER_STOPS
            "an error to stop at, and the estimator `{estimator}` does not stop by itself"
            help "leave `error` out, or use `estimator: {stopping}`" also "this estimator";
        LevelBits { bits: u32, most: u32, estimator: &'static str, counting: &'static str } = LEVEL_BITS
            "the estimator `{estimator}` looks the phase of a path's level up, and a comparator of {bits} \
             bits has too many levels: at most {most} bits"
            help "use `estimator: {counting}`, which counts where it cannot look up, or fewer bits"
            also "these bits";
        Dimensions { dimensions: usize, most: usize } = TOO_MANY_IDS
            "{dimensions} coordinates per path; the digital net has {most}";
        PathBits { bits: u64, most: u32 } = TOO_MANY_IDS "{bits} path bits; an id holds {most}";
        CoordinateBits { coordinate: String, bits: u32, most: u32 } = TOO_MANY_IDS
            "{bits} bits for {coordinate}; a coordinate holds {most}";
        LatticeBits { path: u32, sum: u32 } = TOO_MANY_IDS
            "{path} path bits, but the product lattice's coordinates have {sum} in all";
    }

    /// Problems with the circuit that a scene compiles to.
    Circuit {
        Qubits { used: u64, most: u64, auto: bool } = BUDGET_QUBITS
            { over(*used, *most, "qubits") } label { format!("at most {}", grouped(*most)) }
            help { Some(if *auto {
                "no way to lay it out needs fewer; use fewer bits of `precision.fraction`, or a shorter \
                 list of `sampling.depths`; or raise `budget.qubits`"
            } else {
                "`circuit.uncompute: auto` finds the cheapest circuit that fits; or use fewer bits of \
                 `precision.fraction`, or raise `budget.qubits`"
            }.to_owned()) };
        Toffolis { used: u64, most: u64, scoped: bool, running: bool } = BUDGET_TOFFOLI
            { over(*used, *most, "Toffoli gates") } label { format!("at most {}", grouped(*most)) }
            help { let cheaper = match (scoped, running) {
                (true, _) => "`circuit.uncompute: keep` needs fewer gates, for more qubits",
                (_, false) => "`circuit.nearest: running` needs fewer gates",
                _ => "each entry of `sampling.depths` traces the scene once more",
              };
              Some(format!(
                "{cheaper}; or use fewer bits of `precision.fraction`, or raise `budget.toffoli`")) };
        UnboundedQuotient = QUOTIENT_UNBOUNDED
            "an expression of the scene divides by what may be zero, so that no register is wide enough \
             for the quotient" help "keep the divisor away from 0, as in `a / (b + 0.01)`";
        UnboundedFunction = QUOTIENT_UNBOUNDED
            "an expression of the scene takes a logarithm, a power or a tangent where it may be infinite, so \
             that no register is wide enough for it"
            help "keep its operand away from there, as in `log(a + 0.01)`; a circuit computes both branches of \
                  `if_less`";
        TooWide { what: &'static str, bits: u32, most: u32, whole: u32,
                  value: Option<(&'static str, String)> } = NUMBER_TOO_WIDE
            { match value {
                Some((key, material)) => format!(
                    "a number that `{key}` of the material `{material}` takes on the way needs {bits} \
                     bits and a register has at most {most}"),
                None => format!("{what} needs {bits} bits and a register has at most {most}"),
            } }
            help { Some(match value {
                Some(("exponent", _)) => format!(
                    "lower the exponent, or keep `map: auto`, which samples the lobe and takes no power \
                     of a cosine; numbers may go up to 2^{whole}"),
                Some(_) => format!(
                    "keep every part of it below 2^{whole}, as in `min(1 / x, 100)`; each bit less of \
                     `precision.fraction` doubles that"),
                None => "choose a smaller `precision.fraction`, or bring the camera nearer to the geometry"
                    .to_owned(),
            }) };
        TooManyFaces { faces: usize, most: usize } = TOO_MANY_FACES
            "the scene has {faces} faces, and tables of faces hold at most {most}"
            help "use a coarser mesh";
        SphereInTable = SPHERE_IN_TABLE
            "a search over the numbers of faces looks faces up in tables, which hold polygons alone"
            help "search with `--visibility classical`, or draw the sphere as a mesh";
        SmallCell { fraction: u32, needed: u32 } = SMALL_PART
            "beside the size of the scene these cells have too few of {fraction} fraction bits"
            help { Some(finer(*needed, "make the cells larger", "make the cells larger")) };
        ThinSmoothFace { fraction: u32, needed: u32 } = SMALL_PART
            "the normals of this mesh change over widths that have too few of {fraction} fraction bits"
            help { Some(finer(
                *needed,
                "`smooth: 0`",
                "write `smooth: 0`, or remove the thinnest faces of the mesh",
            )) };
        ThinColouredFace { fraction: u32, needed: u32 } = SMALL_PART
            "the colours of this mesh change over widths that have too few of {fraction} fraction bits"
            help { Some(finer(
                *needed,
                "`colors: none`",
                "write `colors: none`, or remove the thinnest faces of the mesh",
            )) };
        SmallSphere { fraction: u32, needed: u32 } = SMALL_PART
            "beside the size of the scene this sphere has too few of {fraction} fraction bits"
            help { Some(finer(
                *needed,
                "draw what is large as a quad",
                "draw what is large, such as a ground, as a quad in place of a sphere",
            )) };
    }
}

/// Advice on numbers that need `needed` fraction bits: to set them or to do `other`; to do `only` if
/// no scene may have them.
fn finer(needed: u32, other: &str, only: &str) -> String {
    if needed <= 30 {
        format!("set `precision.fraction: {needed}`, or {other}")
    } else {
        only.to_owned()
    }
}

fn over(used: u64, most: u64, what: &str) -> String {
    let (more, used) = (grouped(used - most), grouped(used));
    format!("the circuit has {used} {what}, {more} more than the budget allows")
}
