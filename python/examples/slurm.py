"""A picture by jobs of Slurm, which submitit submits."""

import sys

import submitit

import qrt

if __name__ == "__main__":
    scene = qrt.load(sys.argv[1])
    executor = submitit.AutoExecutor(folder="jobs")
    executor.update_parameters(timeout_min=60, cpus_per_task=4)
    picture = qrt.distributed.render(scene, executor, tiles=100, threads=4, seed=1)
    picture.save("picture.png")
