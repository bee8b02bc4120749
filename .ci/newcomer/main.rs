//! A newcomer's first program: a scene from a YAML file, compiled, and its picture both ways.

use qrt::prelude::*;
use qrt::runtime::image::ImageError;

qrt! { pub scene Room from "box.yaml" }

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let compiled = render_compiled::<Room>(&options)?;
    let interpreted = render(&load("box.yaml".as_ref(), &[])?.valid, &options)?;
    assert_eq!(compiled.image, interpreted.image);
    compiled.save("box.png")?;
    // The crate asks for no pictures of this kind.
    let refused = Encoding::for_path("box.exr", None);
    assert!(matches!(
        refused,
        Err(ImageError::Feature { feature: "exr" })
    ));
    println!("box.png: {} Toffolis a call of the oracle", Room::TOFFOLI);
    Ok(())
}

/// A scene's own circuit in a test, with the stack that tests have.
#[test]
fn the_box_is_rendered() {
    let options = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let picture = render_compiled::<Room>(&options).unwrap();
    assert!(picture.image.pixels.iter().any(|pixel| pixel[0] > 0.0));
}
