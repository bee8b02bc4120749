use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        quad floor: white { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) },
        comparator { 8 },
    }
}

fn main() {
    Room::scene();
}
