"""A picture by workers of Ray."""

import sys

import ray

import qrt


class Pool:
    """Ray's tasks as futures."""

    def submit(self, function, *arguments):
        return ray.remote(function).remote(*arguments).future()


if __name__ == "__main__":
    ray.init()
    picture = qrt.distributed.render(qrt.load(sys.argv[1]), Pool(), seed=1)
    picture.save("picture.png")
