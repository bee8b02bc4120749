//! What a newcomer writes first: a scene from a YAML file, compiled, and its picture both ways.

use qrt::prelude::*;

qrt! { pub scene Room from "box.yaml" }

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = Options {
        model: Model::Fixed,
        ..Options::default()
    };
    let compiled = render_compiled::<Room>(&options)?;
    let interpreted = render(&load("box.yaml".as_ref(), &[])?.valid, &options)?;
    assert_eq!(compiled.image, interpreted.image);
    let path = std::path::Path::new("box.png");
    save(
        path,
        &compiled.image,
        &compiled.metadata()?,
        Encoding::of(path, None)?,
    )?;
    println!("box.png: {} Toffolis a call of the oracle", Room::TOFFOLI);
    Ok(())
}
