use qrt::prelude::*;

qrt! {
    #[derive(Clone, Debug)]
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 by 8,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(3, 2, 1) },
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 6, lights: none },
        depth primary { bits: (6, 6) },
        depth secondary { bits: (6, 6) },
    }
}

qrt! { scene Hall from "scenes/faulty.yaml" }

const LAMP: u32 = Room::MATERIALS.lamp;

#[reversible]
fn on(material: &UInt<2>, height: &Fixed<4, 14>, good: &mut Bool) {
    good ^= material == LAMP && height < 0.5;
}

impl std::fmt::Display for Room {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad("a room")
    }
}

fn picture<C: CompiledOracle>() -> Result<Rendered, RenderError> {
    render_compiled::<C>(&RenderOptions::default())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = RenderOptions::default();
    let counted = count_where::<Room>(&options, |m, path, good| {
        on(m, &path.ray1.material, &path.ray1.origin.y, good);
    })?;
    let (mut state, id) = State::path::<Hall>(0, [0, 0], 3)?;
    let distance = Hall::LAYOUT.ray0.distance;
    let seen = Hall::within(&mut state, &id, |state, path| {
        distance.value(state.bits(path.word(&distance).register), [0, 0])
    });
    println!("{Room} {:?} {seen} {}", Room::FACES.floor, counted.fraction());
    for polygon in Hall::scene().polygons() {
        println!("{:?} {}", polygon, Hall::MATERIALS.white);
    }
    let film: [u8; Room::DEPTH] = [0; Room::DEPTH];
    assert_eq!((film.len(), picture::<Room>()?.image), (2, picture::<Hall>()?.image));
    Ok(())
}
