//! Exports the scene for Mitsuba 3.

use super::ExportArgs;
use crate::cli::failure::Failure;
use crate::cli::files::{Output, keep_apart, named_after};
use crate::cli::terminal;
use qrt_lab::mitsuba::{Exported, export};
use qrt_lab::shell;
use qrt_runtime::replace_file::replace_file;
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) fn export_scene(args: &ExportArgs) -> Result<(), Failure> {
    if let Some(flag) = args.of_circuits() {
        return Err(Failure::Usage(format!(
            "{flag} is of a pixel's circuit, and --format mitsuba writes the scene: leave it out"
        )));
    }
    let file = args
        .output
        .clone()
        .unwrap_or_else(|| named_after(&args.scene.scene, "xml"));
    let stem = file.file_stem().and_then(|stem| stem.to_str());
    let Some(stem) = stem.filter(|_| file != Path::new("-")) else {
        return Err(Failure::Usage(
            "a scene for Mitsuba is several files: name the first, such as box.xml".to_owned(),
        ));
    };
    let output = Output::new(&file)?;
    keep_apart([&*args.scene.scene], &[&output])?;
    let loaded = args.scene.load()?;
    let scene = &loaded.valid;
    let Exported { text, meshes } =
        export(scene, stem).map_err(|error| loaded.report(vec![error.problem()]))?;
    let paths: Vec<PathBuf> = (meshes.iter().map(|mesh| file.with_file_name(&mesh.file))).collect();
    let beside: Vec<Output> = paths
        .iter()
        .map(|path| Output::new(path))
        .collect::<Result<_, _>>()?;
    let all: Vec<&Output> = std::iter::once(&output).chain(&beside).collect();
    let inputs = scene.files().iter().map(PathBuf::as_path);
    keep_apart(inputs.chain([&*args.scene.scene]), &all)?;
    all.iter().try_for_each(|output| output.try_writing())?;
    // The scene is written last, so that the files that it names exist when it does.
    for (output, mesh) in beside.iter().zip(&meshes) {
        write(output, &mesh.bytes)?;
    }
    write(&output, text.as_bytes())?;
    let faces = scene.surface_of_faces().len();
    if args.json {
        let files: Vec<String> = paths
            .iter()
            .map(|path| path.display().to_string())
            .collect();
        let told = json!({
            "version": 1,
            "qrt": env!("CARGO_PKG_VERSION"),
            "scene": scene.scene().name,
            "scene_hash": scene.fingerprint().to_string(),
            "file": file.display().to_string(),
            "format": "mitsuba",
            "meshes": files,
            "faces": faces,
        });
        return terminal::print(&format!("{told:#}\n"));
    }
    terminal::print(&format!(
        "{0}: for Mitsuba 3, with {faces} faces, those of {1} in .ply files beside it\n\
         mitsuba -m scalar_rgb {2} -D spp=1024     renders it\n",
        file.display(),
        match meshes.len() {
            1 => "1 material".to_owned(),
            n => format!("{n} materials"),
        },
        shell::file(&file),
    ))
}

fn write(output: &Output, bytes: &[u8]) -> Result<(), Failure> {
    let path = output.path()?;
    replace_file(path, |out| out.write_all(bytes)).map_err(|error| Failure::file(path, &error))
}
