#![allow(clippy::all, clippy::pedantic, missing_docs)]
use glam::DVec3;
use qrt_core::scene::*;
use qrt_core::valid::*;
use qrt_runtime::machines::*;
use std::time::Instant;

pub fn load(path: &str, depth: usize, path_bits: u32, bits: u32, wh: u32, map: Map) -> ValidScene {
    let text = std::fs::read_to_string(path).unwrap();
    let mut mats = vec![];
    let mut polys = vec![];
    let mut cam = None;
    for line in text.lines() {
        let mut it = line.split_whitespace();
        let k = it.next().unwrap();
        if k == "mat" {
            let kind = it.next().unwrap();
            let a: Vec<f64> = it.map(|x| x.parse().unwrap()).collect();
            let z = [0.0; 3];
            let (radiance, scatter) = match kind {
                "lambertian" => (
                    z,
                    Scatter::Lambertian {
                        albedo: [a[0], a[1], a[2]],
                    },
                ),
                "emitter" => (
                    [a[0], a[1], a[2]],
                    if a[3] == 0.0 {
                        Scatter::Black
                    } else {
                        Scatter::Lambertian {
                            albedo: [a[3], a[4], a[5]],
                        }
                    },
                ),
                "mirror" => (
                    z,
                    Scatter::Mirror {
                        reflectance: [a[0], a[1], a[2]],
                    },
                ),
                "dielectric" => (z, Scatter::Dielectric { ior: a[0] }),
                "ggx" => (
                    z,
                    Scatter::Ggx {
                        alpha: a[0],
                        reflectance: [a[1], a[2], a[3]],
                    },
                ),
                _ => panic!(),
            };
            mats.push(Surface {
                name: kind.into(),
                radiance,
                scatter,
            });
        } else if k == "cam" {
            let a: Vec<f64> = it.map(|x| x.parse().unwrap()).collect();
            let v = |i: usize| DVec3::new(a[i], a[i + 1], a[i + 2]);
            cam = Some(Camera::Perspective(Perspective {
                eye: v(0),
                target: v(3),
                up: v(6),
                vfov: a[9],
            }));
        } else {
            let m: u32 = it.next().unwrap().parse().unwrap();
            let a: Vec<f64> = it.map(|x| x.parse().unwrap()).collect();
            let v = |i: usize| DVec3::new(a[3 * i], a[3 * i + 1], a[3 * i + 2]);
            if k == "quad" {
                let n = (v(1) - v(0)).cross(v(2) - v(0)).normalize();
                if (v(3) - v(0)).dot(n).abs() < 1e-9 {
                    polys.push(Polygon {
                        vertices: [v(0), v(1), v(2), v(3)],
                        corners: 4,
                        surface: m,
                    });
                } else {
                    polys.push(Polygon {
                        vertices: [v(0), v(1), v(2), v(2)],
                        corners: 3,
                        surface: m,
                    });
                    polys.push(Polygon {
                        vertices: [v(0), v(2), v(3), v(3)],
                        corners: 3,
                        surface: m,
                    });
                }
            } else {
                polys.push(Polygon {
                    vertices: [v(0), v(1), v(2), v(2)],
                    corners: 3,
                    surface: m,
                });
            }
        }
    }
    let mut depths = vec![DepthSampling {
        bits: [bits, bits],
        map: Map::Auto,
    }];
    depths.resize(
        depth,
        DepthSampling {
            bits: [bits, bits],
            map,
        },
    );
    let scene = Scene {
        name: "dev".into(),
        camera: cam.unwrap(),
        film: Film {
            width: wh,
            height: wh,
        },
        materials: vec![],
        geometry: vec![],
        sampling: Sampling {
            sequence: Sequence::DigitalNet,
            path_bits,
            depths,
        },
        precision: Precision { fraction: None },
        comparator: Comparator {
            bits: 10,
            at: ComparatorAt::Midpoints,
        },
        counting: Counting {
            phase_bits: 8,
            repetitions: 1,
            window: Window::Sine,
            estimator: Estimator::Sine,
        },
        circuit: Circuit {
            uncompute: Uncompute::Keep,
            nearest: Nearest::Running,
        },
        accuracy: None,
        budget: None,
    };
    from_parts(scene, mats, polys)
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let name = &args[1];
    let depth: usize = args[2].parse().unwrap();
    let path_bits: u32 = args[3].parse().unwrap();
    let wh: u32 = args.get(4).map_or(16, |x| x.parse().unwrap());
    let map = match args.get(5).map(|s| s.as_str()) {
        Some("cos") => Map::CosineHemisphere,
        Some("uni") => Map::UniformHemisphere,
        _ => Map::Auto,
    };
    let scene = load(
        &format!("/tmp/dev_{name}.txt"),
        depth,
        path_bits,
        10,
        wh,
        map,
    );
    let real = Real::new(&scene, 1).unwrap();
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
