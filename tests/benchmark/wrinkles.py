#!/usr/bin/python3
"""Wrinkles of a membrane at low Ca: without resistance to bending their length follows the mesh, with it they do not.

    tests/benchmark/wrinkles.py  # n = 6, 9, 12: minutes
    tests/benchmark/wrinkles.py --meshes 6 9 12 18 --modulus 0.002

A neo-Hookean capsule in shear at Ca = 0.1, compressed along its belt, on a mesh that is turned out of the planes of
symmetry so that no wave is left out. The load is expanded in spherical harmonics of the place on the unstressed sphere;
waves are degrees of 9 and more, which the flow does not force. Membranes without bending stiffness have no shortest
unstable wave, so the shortest that elements carry grows fastest, about two elements long. Bending moduli in R^2 G_s.
"""

import argparse

from package import answer, numpy, plt, studies, style
import waves

DECK = "inputs/shear_neo_hookean.yaml"
QUIET = 1e-3  # share of the load's power in waves below which there are none


def outcome(study, n, modulus, parsed):
    return study.run(DECK,
                     {"Surface/elements per side": n, "Membrane/capillary number": parsed.ca,
                      "Membrane/bending modulus": modulus / parsed.ca, "Particle/orientation": "[20.0, 35.0, 50.0]",
                      "Time/final time": parsed.time, "Output/interval": 0.5, "Time/tolerance": 3e-4})


def spectra(one, start):
    """Mean power by degree over the snapshots from a time on."""
    found = [waves.Spectrum(shot) for shot in one.run.snapshots() if shot.time >= start]
    mean = found[0]
    mean.power = sum(each.power / each.power.sum() for each in found) / len(found)
    return mean


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", nargs="+", type=int, default=[6, 9, 12], metavar="N",
                        help="elements along a side of the cube (default: 6 9 12)")
    parser.add_argument("--modulus", nargs="+", type=float, default=[0.0, 0.0005, 0.005],
                        help="bending moduli over R^2 G_s (default: 0, 0.0005, 0.005)")
    parser.add_argument("--ca", type=float, default=0.1, help="default: %(default)s")
    parser.add_argument("--time", type=float, default=5.0,
                        help="end of the runs (default: %(default)s); spectra are means over their last two time units")
    studies.arguments(parser, "results/wrinkles")
    parsed = parser.parse_args()
    study = studies.study(parsed)

    figure, grid = plt.subplots(len(parsed.modulus), 3, figsize=(10.8, 3.4 * len(parsed.modulus)), squeeze=False)
    rows = []
    for (left, middle, right), modulus in zip(grid, parsed.modulus):
        lengths = []
        for n, color in zip(parsed.meshes, style.RUNS):
            one = outcome(study, n, modulus, parsed)
            if not one.done:
                print(f"n = {n}: {one.message}")
                continue
            spectrum = spectra(one, parsed.time - 2)
            size = element_size(n)
            # the wave: largest power beyond the smooth degrees; in odd degrees only, since the capsule is point
            # symmetric
            wave = waves.SMOOTH + 1 + int(spectrum.power[waves.SMOOTH + 1:].argmax())
            t, d = one.series["time"], one.series["taylor_inertia"]
            late = t >= parsed.time - 2
            mean = numpy.trapz(d[late], t[late]) / (t[late][-1] - t[late][0])
            waved = spectrum.short > QUIET
            if waved:
                lengths.append((size, spectrum.wavelength(wave)))
            length = spectrum.wavelength(wave)
            rows.append((modulus, n, size, wave if waved else "", length if waved else "", spectrum.mean_degree,
                         spectrum.short, mean, numpy.ptp(d[late]), one.seconds))
            words = f"wave of degree {wave}, {length:.3f} R = {length / size:.2f} elements" if waved else "no waves"
            print(f"E_b = {modulus:g} R^2 G_s, n = {n}: {words}; share beyond degree {waves.SMOOTH} "
                  f"{spectrum.short:.1e}; D = {mean:.5f}, range {numpy.ptp(d[late]):.1e}; {one.seconds:.0f} s",
                  flush=True)
            odd = spectrum.degrees % 2 == 1
            left.semilogy(spectrum.degrees[odd], spectrum.power[odd], "-", color=color, label=f"n = {n}")
            if waved:
                left.plot(wave, spectrum.power[wave], "o", color=color, ms=5)
            middle.plot(t, d, color=color, label=f"n = {n}")
        left.set(title="no bending" if modulus == 0 else f"E_b = {modulus:g} R² G_s", xlabel="degree",
                 ylabel="power of the load", ylim=(1e-9, 2))
        left.legend(loc="best")
        middle.set(xlabel="time", ylabel="Taylor parameter D", ylim=(0.9 * rows[-1][7], 1.1 * rows[-1][7]))
        if lengths:
            right.plot([1 / s for s, _ in lengths], [length for _, length in lengths], "o-", color=style.RUNS[0])
        else:
            right.annotate("no waves", (0.5, 0.5), xycoords="axes fraction", ha="center")
        sizes = [element_size(n) for n in parsed.meshes]
        right.plot([1 / s for s in sizes], [2.25 * s for s in sizes], color=style.FAINT, linestyle=(0, (4, 3)),
                   label="2.25 elements")
        right.set(xlabel="elements a radius", ylabel="wavelength over R", ylim=(0, 0.9))
        right.legend(loc="best")
    words = ["--meshes", *map(str, parsed.meshes), "--modulus", *(f"{m:g}" for m in parsed.modulus)]
    figure.supxlabel(r"\$ " + studies.command_of(__file__, *words), x=0.01, ha="left", fontsize=7.5)
    studies.write_table(parsed.output / "wrinkles.csv",
                        ["modulus", "elements_per_side", "element_size", "degree", "wavelength", "mean_degree",
                         "short_share", "taylor_inertia", "range", "seconds"], rows)
    style.save(figure, parsed.output / "wrinkles.png")


def element_size(n):
    """Mean size of an element on the unit sphere."""
    return (4 * numpy.pi / (6 * n * n)) ** 0.5


if __name__ == "__main__":
    answer(main)
