use qrt::prelude::*;

macro_rules! unchanged {
    ($($item:item)*) => { $($item)* };
}

unchanged! {
    #[reversible]
    fn add(a: &UInt<4>, b: &mut UInt<8>) {
        b += a;
    }

    #[reversible]
    fn wrong(a: &UInt<8>, b: &mut UInt<8>) {
        add(&a, &mut b);
    }
}

fn main() {}
