use qrt::prelude::*;

qrt! {
    pub scene Room {
        const WHITE: f64 = 0.73;
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material white: lambertian { albedo: rgb(WHITE, WHITE, WITE) },
        quad floor: white { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) },
    }
}

fn main() {
    Room::scene();
}
