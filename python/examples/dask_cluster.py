"""A picture by workers of Dask, here four of this machine."""

import sys

import distributed

import qrt

if __name__ == "__main__":
    scene = qrt.load(sys.argv[1])
    with distributed.Client(n_workers=4, threads_per_worker=1) as client:
        picture = qrt.distributed.render(scene, client, seed=1)
    picture.save("picture.png")
