#!/usr/bin/python3
"""Drag and viscosity of cubic arrays of rigid spheres, compared with the literature.

    tests/benchmark/arrays.py drag 0.2 0.45 --elements 6 8
    tests/benchmark/arrays.py viscosity

`drag` prints K = F/(6 pi mu a U) for spheres that are held fixed, by the integral equation of the first kind. F is the
drag of a sphere, a its radius, mu the viscosity and U the mean velocity over the cell.

`viscosity` prints a coefficient k for free spheres. At time zero the mean stress is 2 mu (1 + v) E, where E is the rate
of strain, v = 5/2 phi/(1 - k phi + ...) and phi the volume fraction. In the flow alpha the array is stretched along its
axes, in the flow beta it is sheared. k is extrapolated to phi = 0 from three volume fractions, with further terms
proportional to phi^(2/3) and phi^(4/3). The last column is k of Nunan & Keller (J. Fluid Mech. 142, 1984).
"""

import itertools

from package import SCENES, answer, command_line, numpy, table, tanktread

ARRAYS = {"simple": (1, numpy.eye(3)), "body-centred": (2, (1 - 2 * numpy.eye(3)) / 2),
          "face-centred": (4, (1 - numpy.eye(3)) / 2)}
K = {"simple": (3.787, -0.858), "body-centred": (0.14079, 1.57281), "face-centred": (0.23611, 1.50926)}
FLOWS = {"alpha": "uniaxial extension", "beta": "simple shear"}


def main():
    parser = command_line(__doc__)
    parser.add_argument("what", choices=("drag", "viscosity"))
    parser.add_argument("fractions", nargs="*", type=float,
                        help="volume fractions (default: 0.001 0.064 0.2 for drag, 0.0025 0.005 0.01 for viscosity)")
    parser.add_argument("--elements", nargs="+", type=int, default=[6],
                        help="elements per side of a sphere (default: 6)")
    parser.add_argument("--quadrature", type=float, default=1e-7, help="Quadrature/tolerance (default: %(default)g)")
    parser.add_argument("--arrays", nargs="+", choices=ARRAYS, default=list(ARRAYS), help="arrays (default: all)")
    arguments = parser.parse_args()

    def of(array, fraction, n, settings):
        """Returns the series of a run."""
        spheres, vectors = ARRAYS[array]
        side = (4 * numpy.pi / 3 * spheres / fraction) ** (1 / 3)
        return tanktread.run(SCENES / "arrays.yaml", settings | {
            "Domain/lattice vectors": (side * vectors).ravel().tolist(), "Quadrature/tolerance": arguments.quadrature,
            "Particles/sphere/Surface/elements per side": n}).series

    (drag if arguments.what == "drag" else viscosity)(of, arguments)


def drag(of, arguments):
    held = {"Flow/type": "uniform", "Flow/velocity": "[1, 0, 0]", "Particles/sphere/motion": "prescribed",
            "Solvers/rigid bodies": "first kind"}
    cases = itertools.product(arguments.arrays, arguments.fractions or (0.001, 0.064, 0.2), arguments.elements)
    table(["array", "volume fraction", "n", "K"], (
        [*case, f"{of(*case, held)['sphere/drag_x1'][0] / (6 * numpy.pi):.10g}"] for case in cases))


def viscosity(of, arguments):
    fractions = numpy.array(arguments.fractions or (0.0025, 0.005, 0.01))
    powers = fractions[:, None] ** (2 / 3 * numpy.arange(len(fractions)))

    def row(array, flow, n):
        free = {"Particles/sphere/motion": "free", "Flow/type": FLOWS[flow]}
        v = [of(array, fraction, n, free)["relative_viscosity"][0] - 1 for fraction in fractions]
        k = numpy.linalg.solve(powers, (1 - 2.5 * fractions / v) / fractions)[0]
        return [array, flow, n, f"{k:.5f}", K[array][flow == "beta"]]

    table(["array", "flow", "n", "k", "Nunan & Keller"],
          itertools.starmap(row, itertools.product(arguments.arrays, FLOWS, arguments.elements)))


if __name__ == "__main__":
    answer(main)
