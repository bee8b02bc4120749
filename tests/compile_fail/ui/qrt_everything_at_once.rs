use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 400 },
        film: 8 by 8,
        material white: lambertian { albedo: rgb(0.7, 0.7, 1.7) },
        quad floor: whit { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) },
        triangle: white { (0, 2, 0), (1, 2, 0), (2, 2, 0) },
    }
}

fn main() {
    Room::scene();
}
