use qrt::prelude::*;

struct Room;

fn main() {
    let _ = count_where::<Room>(&Options::default(), |_, _, _| {});
}
