"""Makes the reference pictures of scenes in this folder by Mitsuba 3, from what `qrt export` writes of them.

    pip install mitsuba
    python tests/references/make_references.py QRT RUNS SAMPLES DEPTH NAME...

QRT is the program. Each scene gets the depths 1 to DEPTH, each of RUNS renders with SAMPLES paths a pixel, whose
scatter is the standard error. Renders add their samples in 32-bit floats, so each has few: with 16,384 the mean of
in_glass at D = 2 was 0.022 % too high, with 512 it is that of a quadrature.

The variant is scalar_rgb, or that of MITSUBA_VARIANT. Smooth metal, which Mitsuba lacks, is defined here from its
textbook, for llvm_ad_rgb alone (DRJIT_LIBLLVM_PATH names the library).
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant(os.environ.get("MITSUBA_VARIANT", "scalar_rgb"))


class SmoothMetal(mi.BSDF):
    """A mirror whose reflectance is that along the normal, R, or more: R + (1 - R) (1 - cos)^5 (Schlick 1994)."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.along = mi.Color3f(mi.ScalarColor3f(props["base_color"]))
        self.m_components = [mi.BSDFFlags.DeltaReflection | mi.BSDFFlags.FrontSide]
        self.m_flags = self.m_components[0]

    def sample(self, ctx, si, sample1, sample2, active):
        cos = mi.Frame3f.cos_theta(si.wi)
        active &= cos > 0
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = mi.Vector3f(-si.wi.x, -si.wi.y, si.wi.z)
        bs.pdf = 1.0
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(+mi.BSDFFlags.DeltaReflection)
        bs.sampled_component = mi.UInt32(0)
        return bs, dr.select(active, self.along + (1 - self.along) * (1 - cos) ** 5, 0)

    def eval(self, ctx, si, wo, active):
        return mi.Color3f(0)

    def pdf(self, ctx, si, wo, active):
        return mi.Float(0)

    def eval_pdf(self, ctx, si, wo, active):
        return mi.Color3f(0), mi.Float(0)

    def to_string(self):
        return "SmoothMetal[]"


mi.register_bsdf("smoothmetal", SmoothMetal)


def smooth(text):
    """Replaces metal of roughness 0 by smooth metal."""
    metal = r'<bsdf type="principled">(.*?)<float name="metallic" value="1"/><float name="roughness" value="0"/>'
    replaced = re.sub(metal, r'<bsdf type="smoothmetal">\1', text)
    if replaced != text and not mi.variant().startswith("llvm"):
        sys.exit("smooth metal needs MITSUBA_VARIANT=llvm_ad_rgb")
    return replaced


def main(qrt, runs, samples, most, *names):
    here = pathlib.Path(__file__).parent
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / f"{name}.xml"
            scene = here / f"{name}.yaml"
            subprocess.run([qrt, "export", scene, "--format", "mitsuba", "-o", out], check=True)
            out.write_text(smooth(out.read_text()))
            for depth in range(1, int(most) + 1):
                # Only the place in the pixel matters to paths of one ray.
                sampler = "multijitter" if depth == 1 else "independent"
                scene = mi.load_file(str(out), max_depth=depth, sampler=sampler)
                seeds = range(1000 * depth, 1000 * depth + int(runs))
                pictures = [np.array(mi.render(scene, spp=int(samples), seed=seed), np.float64) for seed in seeds]
                errors = np.std(pictures, axis=0, ddof=1) / np.sqrt(len(pictures))
                mean = np.mean(pictures, axis=0)
                np.save(here / f"{name}_D{depth}_16.npy", mean.astype(np.float32))
                np.save(here / f"{name}_D{depth}_16_se.npy", errors.astype(np.float32))
                noise = np.sqrt(np.mean(errors**2)) / max(mean.mean(), 1e-30)
                print(f"{name} D={depth}: mean {mean.mean():.6f}, error of a pixel {100 * noise:.3f} %", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
