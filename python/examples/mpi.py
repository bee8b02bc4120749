"""A picture by the ranks of an MPI job: mpirun -n 9 python -m mpi4py.futures mpi.py SCENE."""

import sys

from mpi4py.futures import MPIPoolExecutor

import qrt

if __name__ == "__main__":
    scene = qrt.load(sys.argv[1])
    with MPIPoolExecutor() as pool:
        picture = qrt.distributed.render(scene, pool, seed=1)
    picture.save("picture.png")
