use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 1 x 1,
        material lamp: emitter { radiance: rgb(1, 0.5, 0) },
        quad sky: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
    }
}

qrt! {
    /// The same name.
    pub scene Room<Fixed<2, 12>> {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 2 x 2,
        material lamp: emitter { radiance: rgb(1, 0.5, 0) },
        quad sky: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
    }
}

mod hall {
    qrt::qrt! { pub scene Room from "scenes/lit.yaml" }
}

fn main() {
    let _ = (Room::QUBITS, Room::FACES.sky, hall::Room::scene());
}
