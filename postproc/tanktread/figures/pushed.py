"""Figure of a capsule that passes or blocks a constriction, and the model of an axisymmetric membrane at rest that
touches the wall without friction and closes the channel."""

import numpy
import scipy.integrate

from ..mistakes import expect, log
from . import style
from .register import figure

BARRIER = 1e-5  # B of the energy -B G_s ln(gap) per unstressed area that keeps the membrane away from the wall


@figure(2, 1, 5.6, 6, sharex=True)
def stuck(runs, upper, lower, *, elements: int = 160):
    """Whether a capsule passes a round constriction at a given pressure drop: runs, and a model without friction.

    Upper panel: capillary number Ca = μV/G_s against the position of the centroid. V is the mean velocity in the empty
    channel, G_s the shear modulus. Each run is a horizontal line, which ends in a dot at its last position. In the
    model an axisymmetric neo-Hookean membrane is at rest, touches the wall without friction and closes the channel. The
    curve shows the Ca at which the pressure drop of the empty channel equals the pressure drop across the membrane. Its
    maximum is the critical Ca for any viscosity ratio. Lower panel: velocity of the centroid divided by V.

    elements: number of elements of the model's membrane, from pole to pole"""
    first = runs[0]
    for key, wanted in (("Channel/profile", "constriction"), ("Channel/section", "circle"),
                        ("Membrane/law", "neo-Hookean"), ("Particle/shape", "sphere")):
        expect(first.value(key) == wanted,
               f"{first.directory}: this figure needs {key} `{wanted}`, but it is {first.value(key) or 'not set'}")
    drop = drop_of_velocity(first)
    way, pressure = Pushed(first, elements).through()
    largest, there = highest(way, pressure)
    log.info(f"without friction: critical Ca = {largest / drop:.5g}, centroid there {there:.3f}, "
             f"pressure drop {largest:.5g} G_s / length")
    upper.plot(way, pressure / drop, color=style.INK, label="model: at rest, without friction")
    for run, color in style.coloured(runs):
        x, speed = run.series["centroid_x1"], run.series["velocity_x1"]
        ca = run.value("Membrane/capillary number") or of_flow(run) / run.value("Membrane/shear modulus")
        near = x > way[0] - 0.2
        expect(near.any(), f"{run.directory}: its particle does not come to the constriction")
        upper.plot(x[near], numpy.full(near.sum(), ca), color=color)
        upper.plot(x[-1], ca, "o", color=color, markersize=4)
        label = f"Ca = {ca:g}, {run.value('Flow/held', 'flow rate')} held"
        lower.plot(x[near], speed[near] / run.value("Flow/mean velocity", 1.0), color=color, label=label)
        log.info(f"{run.name}: Ca = {ca:g}, to x = {x[-1]:.4f}, there {speed[-1]:.4g}, "
                 f"smallest film {run.series['gap'].min():.4g}")
    style.finish(upper, ylim=(0, None), ylabel="Ca = μV/G$_s$")
    style.finish(lower, yscale="log", ylabel="velocity / V", xlabel="centroid $x_1$" + first.in_units("length"))


def of_flow(run):
    """Returns the viscosity times the mean velocity of the flow."""
    return run.value("Flow/viscosity", 1.0) * run.value("Flow/mean velocity", 1.0)


def drop_of_velocity(run):
    """Returns the pressure drop of the empty channel divided by viscosity times mean velocity, in 1/length."""
    return run.series["channel_pressure_drop"].max() / of_flow(run)  # the first value is 0 if the flow starts from rest


def highest(way, pressure):
    """Returns the largest pressure and the centroid position at which it occurs, by a parabola fitted to the five
    values around the maximum. `way`: centroid positions of the values `pressure`."""
    top = numpy.argmax(pressure)
    fold = numpy.polyfit(way[top - 2:top + 3] - way[top], pressure[top - 2:top + 3], 2)
    return fold[2] - fold[1]**2 / (4 * fold[0]), way[top] - fold[1] / (2 * fold[0])


def derivatives(function, at):
    """Returns the derivatives (..., k) of a function with values (...) with respect to the k components of the last
    axis of `at`. They are exact up to round-off (complex-step method); the function must accept complex numbers."""
    steps = 1e-30j * numpy.eye(at.shape[-1])
    return numpy.stack([function(at + step).imag / 1e-30 for step in steps], axis=-1)


class Pushed:
    """Axisymmetric membrane of n conical elements between n + 1 rings. The state `z` (n + 1, 2) holds x and the radius
    r of each ring, from the rear pole to the front pole. Tensions are in units of the shear modulus."""

    def __init__(self, run, n, radius=None):
        self.mouth, self.depth = run.value("Channel/radius", 1.0), run.value("Channel/depth", 0.5)
        self.width = run.value("Channel/half length")
        self.radius = radius or run.value("Particle/radius", 1.0)
        unstressed = self.radius / (1 + run.value("Membrane/pre-inflation", 0.0))
        angle = numpy.linspace(0, numpy.pi, n + 1)
        self.sphere = numpy.stack([-numpy.cos(angle), numpy.sin(angle)], 1)  # of radius 1
        x, r = unstressed * self.sphere.T
        self.length, self.ring = numpy.hypot(numpy.diff(x), numpy.diff(r)), (r[1:] + r[:-1]) / 2
        self.area = 2 * numpy.pi * self.ring * self.length
        self.share = (numpy.append(self.area, 0) + numpy.append(0, self.area)) / 2
        self.n, self.volume = n, 4 / 3 * numpy.pi * self.radius**3
        self.rings = numpy.arange(2 * n + 2).reshape(n + 1, 2)  # indices of the two coordinates of each ring in z.flat
        self.numbers = numpy.hstack([self.rings[:-1], self.rings[1:]])  # indices of the four coordinates of each cone
        self.loose = numpy.setdiff1d(self.rings, self.rings[[0, -1], 1])  # free coordinates: all except r of the poles

    def wall(self, x):
        """Returns the radius of the wall at x and its derivative."""
        k, half = numpy.pi / self.width, (numpy.abs(x) < self.width) * self.mouth * self.depth / 2
        return self.mouth - half * (1 + numpy.cos(k * x)), half * k * numpy.sin(k * x)

    def gap(self, z):
        """Returns the radial distance of each ring from the wall (n + 1,)."""
        return self.wall(z[:, 0])[0] - z[:, 1]

    def push(self, z):
        """Returns the radial force of the wall on each ring (n + 1,)."""
        return BARRIER * self.share / self.gap(z)

    def by_barrier(self, z):
        """Returns the gradient (n + 1, 2) of the energy that keeps the membrane away from the wall (see BARRIER)."""
        return self.push(z)[:, None] * numpy.column_stack([-self.wall(z[:, 0])[1], numpy.ones(len(z))])

    def by_energy(self, ends):
        """Returns the gradient (cones, 4) of the elastic energy of each cone with respect to the coordinates (x, r, x,
        r) of its two rings. The energy is (G_s/2) (l1^2 + l2^2 + 1/(l1 l2)^2 - 3) times the unstressed area, with the
        stretches l1, l2. `ends`: the coordinates (cones, 4)."""
        d = ends[:, 2:] - ends[:, :2]
        length = numpy.sqrt((d**2).sum(1))  # not numpy.linalg.norm: complex steps
        s, t = length / self.length, (ends[:, 1] + ends[:, 3]) / (2 * self.ring)
        by_s = numpy.hstack([-d, d]) / (length * self.length)[:, None]
        by_t = numpy.array([0, 0.5, 0, 0.5]) / self.ring[:, None]
        return self.area[:, None] * ((s - 1 / (s**3 * t**2))[:, None] * by_s + (t - 1 / (t**3 * s**2))[:, None] * by_t)

    @staticmethod
    def volumes(z):
        """Returns the volume of each cone (cones,)."""
        x, r = z.T
        return numpy.pi / 3 * numpy.diff(x) * (r[1:]**2 + r[1:] * r[:-1] + r[:-1]**2)

    @staticmethod
    def by_volumes(ends):
        """Returns the gradient (cones, 4) of the volume of each cone with respect to the coordinates of its rings."""
        h, a, b = ends[:, 2] - ends[:, 0], ends[:, 1], ends[:, 3]
        square = a * a + a * b + b * b
        return numpy.pi / 3 * numpy.stack([-square, h * (2 * a + b), square, h * (a + 2 * b)], 1)

    def area_at(self, x):
        """Returns the area of the channel's section at x."""
        return numpy.pi * self.wall(x)[0] ** 2

    def behind(self, z, closed):
        """Returns the volume of the fluid in the constriction upstream of the ring that closes the channel. `closed`:
        index of this ring."""
        whole = scipy.integrate.fixed_quad(self.area_at, -self.width, z[closed, 0], n=20)[0]
        return whole - self.volumes(z)[:closed].sum()

    def system(self, z, closed):
        """Returns gradients (3, n) and Hessians (3, n, n) with respect to the free coordinates, of three functions: the
        energy, the volume of the capsule, and the volume of fluid `behind` the ring `closed`."""
        gradient, matrix = numpy.zeros((3, z.size)), numpy.zeros((3, z.size, z.size))
        ends, behind, ring = numpy.hstack([z[:-1], z[1:]]), slice(closed), slice(closed, closed + 1)
        cones, rings = self.numbers, self.rings
        for k, by, numbers, at in ((0, self.by_energy, cones, ends), (0, self.by_barrier, rings, z),
                                   (1, self.by_volumes, cones, ends), (2, self.area_at, rings[ring, :1], z[ring, :1]),
                                   (2, lambda ends: -self.by_volumes(ends), cones[behind], ends[behind])):
            numpy.add.at(gradient[k], numbers, by(at))
            numpy.add.at(matrix[k], (numbers[:, :, None], numbers[:, None, :]), derivatives(by, at))
        return gradient[:, self.loose], matrix[:, self.loose][:, :, self.loose]

    def rest(self, z, pressures, closed, behind):
        """Computes an equilibrium shape by Newton's method. Returns the shape and the pressures inside the capsule and
        behind it; None if the iteration does not converge. `z`, `pressures`: start values. `behind`: volume of the
        fluid behind the capsule."""
        n = self.loose.size
        for _ in range(60):
            gradient, matrix = self.system(z, closed)
            residual = numpy.append(gradient[0] - pressures @ gradient[1:],
                                    [self.volumes(z).sum() - self.volume, self.behind(z, closed) - behind])
            if abs(residual).max() < 1e-10:
                return z, pressures
            whole = numpy.block([[matrix[0] - numpy.tensordot(pressures, matrix[1:], 1), -gradient[1:].T],
                                 [gradient[1:], numpy.zeros((2, 2))]])
            step = -numpy.linalg.solve(whole, residual)
            part = min(1, 0.05 / abs(step[:n]).max())
            while part > 1e-6:
                trial = z.copy()
                trial.flat[self.loose] += part * step[:n]
                if (self.gap(trial) > 0.1 * self.gap(z))[1:-1].all() and (trial[1:-1, 1] > 0).all():
                    break
                part *= 0.7
            z, pressures = trial, pressures + part * step[n:]
        return None

    def through(self):
        """Returns the centroid positions (m,) of equilibrium shapes, from the first contact with the wall to the
        throat, and the pressure drop (m,) across the capsule at each."""
        z = self.radius * self.sphere
        places = numpy.linspace(-self.width - self.radius, 0, 4000)
        near = (self.wall(z[:, 0] + places[:, None])[0] - z[:, 1]).min(axis=1) < 0.005 * self.radius
        expect(near.any(), "the particle does not touch the wall of the constriction")
        z[:, 0] += places[near.argmax()]
        closed = numpy.argmin(self.gap(z)[1:-1]) + 1
        pressures, behind, step = numpy.array([1.0, 0.0]), self.behind(z, closed), 0.01 * self.volume
        found = []
        while not found or found[-1][0] <= 0:
            rest = self.rest(z, pressures, closed, behind)
            if rest is None:
                step /= 2
                behind -= step
                expect(step >= 1e-5 * self.volume, "the membrane at rest was not found; change --elements")
                continue
            z, pressures = rest
            centroid = self.volumes(z) @ (z[1:, 0] + z[:-1, 0]) / 2 / self.volume
            found.append((centroid, pressures[1]))
            area = 2 * numpy.pi * z[:, 1] * numpy.hypot(*numpy.gradient(z, axis=0).T)
            on_wall = self.push(z) / area.clip(1e-9) + pressures[1] * (numpy.arange(self.n + 1) < closed)
            moved = numpy.argmax(on_wall[2:-2]) + 2
            behind, closed = behind + self.behind(z, moved) - self.behind(z, closed) + step, moved
        return numpy.array(found).T
