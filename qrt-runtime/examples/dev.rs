#![allow(clippy::all, clippy::pedantic, missing_docs)]
use qrt_runtime::machines::*;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let name = &args[1];
    let depth: usize = args[2].parse().unwrap();
    let path_bits: u32 = args[3].parse().unwrap();
    let wh: u32 = args.get(4).map_or(16, |x| x.parse().unwrap());
    let map = args.get(5).cloned().unwrap_or("auto".into());
    let bits = 10;
    let depths = std::iter::once(format!("{{bits: [{bits}, {bits}]}}"))
        .chain((1..depth).map(|_| format!("{{bits: [{bits}, {bits}], map: {map}}}")))
        .collect::<Vec<_>>()
        .join(", ");
    let sets = vec![
        format!("sampling.path_bits={path_bits}"),
        format!("film.width={wh}"),
        format!("film.height={wh}"),
        format!("sampling.depths=[{depths}]"),
    ];
    let path = if name.contains('/') {
        name.clone()
    } else {
        format!("/work/shared/references/{name}.yaml")
    };
    let loaded = match qrt_core::front::load(path.as_ref(), &sets) {
        Ok(l) => l,
        Err(e) => {
            eprintln!("{e}");
            std::process::exit(2)
        }
    };
    let t = Instant::now();
    let real = Real::new(&loaded.valid, 1).unwrap();
    eprintln!("stage {:.3} s", t.elapsed().as_secs_f64());
    let pixels: Vec<[u32; 2]> = (0..wh * wh).map(|i| [i % wh, i / wh]).collect();
    let t = Instant::now();
    let sums = real.sums(&pixels);
    let s = t.elapsed().as_secs_f64();
    let n = real.paths() as f64;
    eprintln!(
        "{name} D={depth} {:.3} s {:.2} Mpaths/s/core",
        s,
        n * pixels.len() as f64 / s / 1e6
    );
    let mut out = Vec::new();
    for sum in &sums {
        for c in sum.colour {
            out.extend((c / n).to_le_bytes());
        }
    }
    std::fs::write("/tmp/dev_out.bin", out).unwrap();
    eprintln!("bound {:?}", real.stage().bound());
}
