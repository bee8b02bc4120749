//! The oracle of nearest hits, which marks the faces that a ray meets nearer than the nearest
//! known.

use super::target::target;
use super::{OracleError, OracleOptions, register_of};
use crate::compile::{self, Builder, Label, PixelWord, Role, StageName};
use qrt_circuit::lower::{self, Cost};
use qrt_circuit::{Bit, BlockId, Instruction, Op, Operand, Program, RegisterId, Word};
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{Arith, FaceTable, Named, Quantity, Stage, TracerPart};
use std::sync::Mutex;

/// Most faces of a table whose address is a face's number: one number of 16 bits stands for none.
pub const MOST_FACES: usize = (1 << 16) - 1;

/// The oracle of a scene's nearest hits.
///
/// For a path, whose index is a basis state, it flips the phase of every basis state (primitive)
/// whose face the path's first ray meets before the best hit so far:
///
/// ```text
/// compute        id -> ray;  primitive -> face, by table;  (ray, face) -> meets, distance
/// nearer         meets and (distance, primitive) < (best.distance, best.primitive)
/// flip           Z on that bit
/// undo compute
/// ```
///
/// Pairs are compared by their distances and, if these are equal, by their numbers. The least pair
/// is therefore the hit that a running nearest keeps, which tests the faces in turn. `best` is
/// classical: the last measurement of the search. Before the first, it is the greatest distance and
/// the number 0, so that every face that the ray meets is marked.
///
/// Grover's iterate over `primitive` finds a marked face (Lanzagorta & Uhlmann, *Quantum
/// rendering*, 2005). Searches repeated with the last result as `best` find the minimum (Durr &
/// Hoyer 1996). The ray, the plane and the edges are those of the tracer (see
/// [`qrt_tracer::FaceTable`]), in fixed point. A face's data are rounded to the scene's fraction
/// bits. A circuit with a constant for each face can round products with the constant as a whole,
/// so the two may differ in a distance's last bits, and therefore at faces' edges.
///
/// There are `2^m` basis states for P faces, with the least m above 0 such that `2^m >= P`. States
/// beyond P meet nothing.
#[derive(Clone, Debug)]
pub struct NearestOracle {
    /// The program that computes [`NearestOracle::distance`] and [`NearestOracle::nearer`].
    pub program: Program,
    /// The values of the program's parameters, as functions of the pixel.
    pub parameters: Vec<PixelWord>,
    /// The register of the path index.
    pub id: RegisterId,
    /// The register of the face's number: its index in [`FaceTable::labels`], the order in which a
    /// running nearest tests the faces.
    pub primitive: RegisterId,
    /// The register of the nearest distance so far, in units of `2^-fraction`.
    pub best_distance: RegisterId,
    /// The register of the nearest face's number so far.
    pub best_primitive: RegisterId,
    /// The face's distance, in units of `2^-fraction` of the ray's direction; arbitrary if the ray
    /// does not meet the face.
    pub distance: Operand,
    /// True if the face is nearer than the nearest so far. None if no ray can meet any face.
    pub nearer: Option<Bit>,
    /// The initial value of [`NearestOracle::best_distance`], in units of `2^-fraction`. Before a
    /// face has been found, the number is 0.
    pub t_max: u64,
    /// The label in the scene of each face, and after the last the label that stands for no face.
    pub labels: Vec<u32>,
    /// Number of fraction bits of every number.
    pub fraction: u32,
    /// The paths of a pixel.
    pub points: PathPoints,
}

impl NearestOracle {
    /// The oracle of a scene's primary rays; none if the scene has no faces.
    ///
    /// # Errors
    /// The scene has numbers that no register can hold, or more than [`MOST_FACES`] faces.
    pub fn new(scene: &ValidScene) -> Result<Option<Self>, OracleError> {
        let stage = Stage::of_any_pixel(scene, [0]);
        let list = FaceTable::new(&stage);
        if list.is_empty() && !list.lacks_spheres {
            return Ok(None);
        }
        fits_table(scene, &list)?;
        let points = PathPoints::new(&scene.scene().sampling)?;
        let options = OracleOptions::default();
        let strategy = options.strategy(scene)?;
        let target = target(scene, &stage, &points, strategy, options)?;
        let fraction = target.fraction;
        let mut builder = Builder::new(target);
        let cx = &mut builder;
        let width = index_bits(list.len());
        let (primitive, face) = cx.given_index("primitive", Role::Id, width);
        let t_max = stage.camera().t_max;
        let t_max = cx.t_max(t_max);
        let most = cx.operand_of(t_max).1[1];
        let units = (1_u64 << fraction) as f64;
        let (best_distance, least) =
            cx.given_number("best.distance", Role::Comparator, most as f64 / units);
        let (best_primitive, number) = cx.given_index("best.primitive", Role::Comparator, width);

        cx.enter(TracerPart::GenerateRay(0));
        let ray = stage.primary_ray(cx);
        cx.leave();
        let named = |quantity| Named { depth: 0, quantity };
        cx.named(named(Quantity::Origin), &ray.origin);
        cx.named(named(Quantity::Direction), &ray.direction);
        cx.enter(TracerPart::FindIntersection(0));
        let (meets, distance) = list.meet(cx, &ray, face);
        let distance = cx.held(distance);
        cx.leave();
        cx.enter_nearer();
        let before = cx.less(distance, least);
        let after = cx.less(least, distance);
        let lower = cx.index_less(face, number);
        let tied = cx.not(after);
        let first = cx.and(tied, lower);
        let nearer = cx.or(before, first);
        let nearer = cx.and(meets, nearer);
        let nearer = cx.truth_bit(nearer);
        cx.leave();

        let distance = cx.operand_of(distance).0;
        let id = builder.id();
        scene.count_recording();
        let recorded = builder.finish()?;
        let parameters = recorded.parameters.clone();
        let roots = register_of(distance)
            .into_iter()
            .chain(nearer.map(|bit| bit.register));
        let (program, renamed) = compile::assemble(
            recorded,
            roots.collect::<Vec<_>>().as_slice().into(),
            options.passes,
            strategy,
            &[id, primitive, best_distance, best_primitive],
            &Mutex::default(),
        );
        let parameters = PixelWord::of_program(&parameters, &program);
        let rename = |register: RegisterId| *renamed.get(&register).unwrap_or(&register);
        Ok(Some(Self {
            program,
            parameters,
            id,
            primitive,
            best_distance,
            best_primitive,
            distance: distance.map_register(rename),
            nearer: nearer.map(|bit| bit.map_register(rename)),
            t_max: most.cast_unsigned(),
            labels: list.labels().to_vec(),
            fraction,
            points,
        }))
    }

    /// The parameters of pixel (column, row).
    pub fn parameter_words(&self, seed: u64, pixel: [u32; 2]) -> Vec<u64> {
        let words = self.parameters.iter();
        words
            .map(|word| word.value(&self.points, seed, pixel))
            .collect()
    }

    /// P, the number of faces.
    pub fn faces(&self) -> usize {
        self.labels.len() - 1
    }

    /// `2^m`, the number of basis states that are searched.
    pub fn states(&self) -> usize {
        1 << self.program.width(self.primitive)
    }

    /// Flips the phase if the face is nearer: the part between compute and uncompute.
    pub fn flip(&self) -> Program {
        let mut program = self.program.clone();
        let block = BlockId(program.blocks.len() as u32);
        let label = Label {
            stage: StageName::Flip,
            depth: None,
        };
        program.blocks.push(label.block(Some(BlockId::ROOT)));
        program.instructions.clear();
        if let Some(bit) = self.nearer {
            program.instructions.push(Instruction {
                op: program.ops.len() as u32,
                inverse: false,
                block,
            });
            program.ops.push(Op::Phase { bit });
        }
        program.inputs = self.program.outputs();
        program
    }

    /// The whole oracle, one query: compute, flip, uncompute.
    pub fn whole(&self) -> Program {
        let mut whole = self.flip();
        let undo = self.program.inverse().instructions;
        let flip = std::mem::take(&mut whole.instructions);
        whole.instructions.clone_from(&self.program.instructions);
        whole.instructions.extend(flip);
        whole.instructions.extend(undo);
        whole.inputs.clone_from(&self.program.inputs);
        whole
    }

    /// The cost of one query in gates, and the most qubits in use at any time.
    pub fn cost(&self) -> (Cost, u32) {
        let whole = self.whole();
        let costs = lower::tally(&whole);
        (costs.into_iter().sum(), lower::most_qubits(&whole))
    }

    /// The words of the distance and the mark, which machines read at the program's end. None for a
    /// value that is the same on all paths.
    pub fn outputs(&self) -> [Option<Word>; 2] {
        let distance = match self.distance {
            Operand::Word(word) => Some(word),
            Operand::Constant(_) => None,
        };
        let nearer = self.nearer.map(|bit| Word {
            register: bit.register,
            offset: bit.index,
            width: 1,
            signed: false,
            shift: 0,
        });
        [distance, nearer]
    }
}

/// Number of bits of a face's number, at least 1.
fn index_bits(faces: usize) -> u32 {
    (usize::BITS - faces.saturating_sub(1).leading_zeros()).max(1)
}

/// Checks that a table holds the faces.
pub(super) fn fits_table(scene: &ValidScene, list: &FaceTable) -> Result<(), OracleError> {
    if let (true, Some(ball)) = (list.lacks_spheres, scene.balls().first()) {
        let primitive = ball.primitive;
        return Err(OracleError::SphereInTable { primitive });
    }
    if list.len() > MOST_FACES {
        return Err(OracleError::TooManyFaces { faces: list.len() });
    }
    Ok(())
}
