//! The materials of glTF files.

use crate::front::meshes::surface;
use crate::scene::meshes::{FileError, FileMaterial, FilePlace};
use crate::scene::{Dielectric, Emitter, Lambertian, Material, Rgb};
use ::gltf::material::AlphaMode;
use qrt_syntax::MeshFile;
use std::collections::BTreeSet;
use std::path::Path;

/// Reads material number `index` of the file at `path`.
pub(super) fn read(path: &Path, material: &::gltf::Material<'_>, index: usize) -> FileMaterial {
    let place = FilePlace::Part(format!("materials[{index}]"));
    let name = material.name().filter(|name| !name.is_empty());
    let name = name.map_or_else(|| format!("material {index}"), str::to_owned);
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let mut left_out = BTreeSet::new();
    let meant = meant(material, &name, &mut left_out);
    FileMaterial {
        label: format!("{file}:{name}"),
        name,
        material: meant.map_err(|what| FileError::new(what, path, place.clone())),
        left_out,
        file: path.to_owned(),
        place,
    }
}

/// Returns the material of the scene language that is meant. Adds the names of properties without a
/// counterpart to `left_out`.
fn meant(
    material: &::gltf::Material<'_>,
    name: &str,
    left_out: &mut BTreeSet<String>,
) -> Result<Material, MeshFile> {
    let pbr = material.pbr_metallic_roughness();
    let transmission = material.transmission();
    let mut leave_out = |property: &str, is_written: bool| {
        if is_written {
            left_out.insert(property.to_owned());
        }
    };
    for (keyword, is_textured) in [
        ("baseColorTexture", pbr.base_color_texture().is_some()),
        ("emissiveTexture", material.emissive_texture().is_some()),
    ] {
        if is_textured {
            let (keyword, name) = (keyword.to_owned(), name.to_owned());
            return Err(MeshFile::Texture { keyword, name });
        }
    }
    let is_rough_by_texture = pbr.metallic_roughness_texture().is_some();
    leave_out("metallicRoughnessTexture", is_rough_by_texture);
    leave_out("normalTexture", material.normal_texture().is_some());
    leave_out("occlusionTexture", material.occlusion_texture().is_some());
    let by_texture = |t: &::gltf::material::Transmission<'_>| t.transmission_texture().is_some();
    leave_out(
        "transmissionTexture",
        transmission.as_ref().is_some_and(by_texture),
    );

    let [red, green, blue, alpha] = pbr.base_color_factor().map(f64::from);
    let base = reflectance("baseColorFactor", [red, green, blue])?;
    let metallic = f64::from(pbr.metallic_factor());
    let roughness = within("roughnessFactor", f64::from(pbr.roughness_factor()))?;
    within("metallicFactor", metallic)?;
    let strength = f64::from(material.emissive_strength().unwrap_or(1.0));
    let radiance = material.emissive_factor().map(|c| f64::from(c) * strength);
    if let Some(value) = radiance
        .into_iter()
        .find(|c| !(0.0..f64::INFINITY).contains(c))
    {
        let keyword = "emissiveFactor".to_owned();
        return Err(MeshFile::NegativeRadiance { keyword, value });
    }
    let alpha = match material.alpha_mode() {
        AlphaMode::Opaque => 1.0,
        AlphaMode::Mask | AlphaMode::Blend => alpha,
    };
    let transmission = transmission.map_or(0.0, |t| f64::from(t.transmission_factor()));
    let is_metal = metallic >= 0.5;
    let is_glass = transmission >= 0.5 && !is_metal || alpha < 0.5;

    if radiance != [0.0; 3] {
        leave_out("alpha", alpha < 1.0);
        leave_out("transmissionFactor", transmission > 0.0);
        let albedo = if is_metal { [0.0; 3] } else { base };
        let albedo = albedo.into();
        return Ok(Emitter { radiance, albedo }.into());
    }
    if is_glass {
        let ior = material.ior().map_or(surface::GLASS, f64::from);
        if !surface::IORS.contains(&ior) {
            return Err(MeshFile::Ior { ior });
        }
        leave_out("alpha", alpha > 0.0 && alpha < 1.0);
        leave_out("baseColorFactor", base != [base[0]; 3]);
        leave_out("roughnessFactor", transmission > 0.0 && roughness > 0.0);
        return Ok(Dielectric::clear(ior).into());
    }
    leave_out("alpha", alpha < 1.0);
    leave_out("transmissionFactor", transmission > 0.0);
    if is_metal {
        leave_out("metallicFactor", metallic < 1.0);
        return Ok(surface::metal(base, roughness));
    }
    leave_out("metallicFactor", metallic > 0.0);
    let albedo = base.into();
    Ok(Lambertian { albedo }.into())
}

fn reflectance(keyword: &str, colour: Rgb) -> Result<Rgb, MeshFile> {
    for part in colour {
        within(keyword, part)?;
    }
    Ok(colour)
}

/// Returns `value` if it is from 0 to 1.
fn within(keyword: &str, value: f64) -> Result<f64, MeshFile> {
    let keyword = keyword.to_owned();
    let is_within = (0.0..=1.0).contains(&value);
    is_within
        .then_some(value)
        .ok_or(MeshFile::NotAlbedo { keyword, value })
}
