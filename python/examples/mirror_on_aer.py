# %% [markdown]
# # A ray tracer as amplitudes
#
# The complete counting circuit of a pixel is run on Qiskit Aer, and its outcomes are compared with theory. The scene is a mirror that shows the edge of a lamp: two rays a path, and 16 paths.

# %%
import numpy
import qrt

text = """
name: mirror
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 2, height: 2 }
materials:
  mirror: { mirror: { reflectance: [1, 1, 1] } }
  lamp: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-1, -1, -1], [1, -1, 1], [1, 1, 1], [-1, 1, -1]], material: mirror }
  - quad: { vertices: [[-2, -1, -1], [-2, 1, -1], [-2, 1, 0.25], [-2, -1, 0.25]], material: lamp }
sampling: { path_bits: 4, depths: [{ bits: [2, 2] }, { bits: [1, 1] }], lights: none }
precision: { fraction: 5 }
comparator: { bits: 1 }
counting: { phase_bits: 4 }
circuit: { uncompute: pebbled }
"""
scene = qrt.parse(text)
oracle = scene.oracle(pixel=(1, 0))
oracle
#> <qrt.Oracle of "mirror", channel r, pixel (1, 0): 10 Toffolis on 15 qubits>

# %% [markdown]
# The circuit has the Hadamards that put all paths in superposition, Grover's iterate with its controlled powers, and the inverse Fourier transform. Each query traces the paths and uncomputes them:

# %%
circuit = oracle.to_qiskit("counting")
print(circuit.num_qubits, "qubits:", {register.name: register.size for register in circuit.qregs})
print(dict(circuit.count_ops()))
#> 20 qubits: {'path': 4, 'comparator': 1, 'work': 10, 'phase_register': 4, 'bond': 1}
#> {'x': 542, 'cx': 528, 'ccx': 270, 'h': 163, 'cz': 30, 'z': 15, 'ry': 8, 'cu1': 6, 'measure': 4}

# %% [markdown]
# Aer knows nothing of light. It returns the probability of each outcome of the phase register:

# %%
from qiskit import transpile
from qiskit_aer import AerSimulator

phase = [circuit.find_bit(qubit).index for register in circuit.qregs if register.name == "phase_register" for qubit in register]
exact = circuit.remove_final_measurements(inplace=False)
exact.save_probabilities(phase, label="phase")
simulator = AerSimulator(method="statevector")
found = simulator.run(transpile(exact, simulator, optimization_level=0)).result().data()["phase"]

# %% [markdown]
# Outcomes $y$ and $T - y$ stand for the same fraction of good indices, $\sin^2(\pi y / T)$. Theory needs $S$ and $N$ alone, which are counted by tracing each path:

# %%
theory = scene.count(pixel=(1, 0))
size = len(found)
for outcome in theory.outcomes:
    mirrored = found[size - outcome.y] if 0 < outcome.y < size // 2 else 0
    probability = found[outcome.y] + mirrored
    bar = "#" * round(40 * probability)
    print(f"{outcome.y:>2}  {numpy.sin(numpy.pi * outcome.y / size) ** 2:.4f}  {probability:.6f}  {outcome.probability:.6f}  {bar}".rstrip())
    assert abs(probability - outcome.probability) < 1e-9
print(f"S/N is {oracle.good}/{oracle.total}")
#>  0  0.0000  0.000798  0.000798
#>  1  0.0381  0.004209  0.004209
#>  2  0.1464  0.316749  0.316749  #############
#>  3  0.3087  0.676769  0.676769  ###########################
#>  4  0.5000  0.001284  0.001284
#>  5  0.6913  0.000059  0.000059
#>  6  0.8536  0.000049  0.000049
#>  7  0.9619  0.000055  0.000055
#>  8  1.0000  0.000028  0.000028
#> S/N is 8/32

# %% [markdown]
# A quantum computer returns one outcome per run. The most frequent of 1,000 runs by Aer, and the interval that qrt gives for $S/N$ after 20 runs of its own:

# %%
measured = simulator.run(transpile(circuit, simulator, optimization_level=0), shots=1000, seed_simulator=7).result().get_counts()
runs = numpy.zeros(size // 2 + 1, dtype=int)
for bits, times in measured.items():
    runs[min(int(bits, 2), size - int(bits, 2))] += times
print(f"y = {runs.argmax()}")
estimate = scene.simulate(pixel=(1, 0), shots=20).estimate
print(f"S/N = {estimate.amplitude:.3f}, from {estimate.interval[0]:.3f} to {estimate.interval[1]:.3f}")
#> y = 3
#> S/N = 0.281, from 0.084 to 0.598
