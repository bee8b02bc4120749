use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad ceiling: white { (-2, 2, 2), (-2, 2, -2), (2, 2, -2), (2, 2, 2) },
    }
    pub scene Hall {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
    }
}

fn main() {
    Room::scene();
    Hall::scene();
}
