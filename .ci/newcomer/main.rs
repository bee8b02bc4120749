//! A newcomer's first program: a scene from a YAML file, compiled, and its picture both ways.

use qrt::prelude::*;
use qrt::runtime::image::ImageError;

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
        Encoding::for_path(path, None)?,
    )?;
    // The crate asks for no pictures of this kind.
    let refused = Encoding::for_path("box.exr".as_ref(), None);
    assert!(matches!(
        refused,
        Err(ImageError::Feature { feature: "exr" })
    ));
    println!("box.png: {} Toffolis a call of the oracle", Room::TOFFOLI);
    Ok(())
}

/// Native code in a test of one's own, with the stack that tests have.
#[test]
fn the_box_is_rendered() {
    let options = Options {
        model: Model::Fixed,
        ..Options::default()
    };
    let picture = render_compiled::<Room>(&options).unwrap();
    assert!(picture.image.pixels.iter().any(|pixel| pixel[0] > 0.0));
}
