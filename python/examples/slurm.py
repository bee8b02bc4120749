"""A picture by an array of Slurm's jobs, which submitit submits: slurm.py SCENE PORTIONS."""

import functools
import sys

import submitit

import qrt

if __name__ == "__main__":
    scene, portions = qrt.load(sys.argv[1]), int(sys.argv[2])
    executor = submitit.AutoExecutor(folder="jobs")
    executor.update_parameters(timeout_min=60, cpus_per_task=4, slurm_array_parallelism=50)
    part = functools.partial(qrt.render_portion, scene, n=portions, threads=4, seed=1, progress=False)
    jobs = executor.map_array(part, range(portions))
    picture = qrt.merge(job.result() for job in jobs)
    picture.save("picture.png")
