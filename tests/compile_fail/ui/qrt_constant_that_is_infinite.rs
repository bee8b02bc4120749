use qrt::prelude::*;

qrt! {
    pub scene Room {
        const FAR: f64 = 1 / 0;
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        triangle: white { (0, 0, 0), (FAR, 0, 0), (0, FAR, 0) },
    }
}

fn main() {
    Room::scene();
}
