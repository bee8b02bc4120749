use qrt::prelude::*;

struct Room;

fn main() {
    let _ = count_where::<Room>(&RenderOptions::default(), |_, _, _| {});
}
