use qrt::prelude::*;

#[reversible]
fn clear(a: &mut UInt<4>) {
    let mut t: Bool = false;
    assert_zero!(a);
    assert_zero!();
    if a[0] {
        assert_zero!(t);
    }
}

fn main() {}
