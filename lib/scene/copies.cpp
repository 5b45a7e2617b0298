#include "scene/copies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/table.hpp"
#include "scene/packing.hpp"
#include "scene/scene.hpp"

namespace tanktread {

namespace {

double ball_volume(double radius) { return 4 * std::numbers::pi / 3 * std::pow(radius, 3); }

/// Centre and orientation of a copy; the orientation is a rotation vector in degrees.
struct Copy {
  Vec3 centre, orientation = Vec3::Zero();
};

Eigen::AngleAxisd rotation(const Vec3& degrees) {
  const double angle = degrees.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle * std::numbers::pi / 180, degrees / angle) : Eigen::AngleAxisd(0, Vec3::UnitX());
}

std::vector<Copy> in_file(const deck::TableFile& file, const std::string& list) {
  std::vector<Copy> copies;
  const deck::TableForm form{{{"x1", "length"}, {"x2", "length"}, {"x3", "length"}, {"r1", "degree"}, {"r2", "degree"}, {"r3", "degree"}}, {3, 6}};
  for (const deck::TableRow& row : deck::read_table(file, list + "/file \"" + file.path + "\"", form)) {
    copies.push_back({Vec3(row.numbers.data())});
    if (row.numbers.size() == 6) copies.back().orientation = Vec3(row.numbers.data() + 3);
  }
  return copies;
}

/// Returns copies on a lattice that is centred at the origin.
std::vector<Copy> on_lattice(const Vec3& counts, const Vec3& spacing) {
  std::vector<Copy> copies;
  for (int i = 0; i < counts[0]; ++i)
    for (int j = 0; j < counts[1]; ++j)
      for (int k = 0; k < counts[2]; ++k) copies.push_back({(Vec3(i, j, k) - (counts - Vec3::Ones()) / 2).cwiseProduct(spacing)});
  return copies;
}

/// Returns the volume of the cell in which copies are placed. A cell with fewer than three periods has no volume.
double volume_of(const stokes::PeriodicCell& cell) {
  if (cell.n() != 3) throw std::logic_error("copies need a cell with three periods");
  return cell.volume();
}

/// Region of copies at random positions.
struct Region {
  double volume;                                            // volume to which the volume fraction of the copies refers
  Vec3 half_sides = Vec3::Zero();                           // half the side lengths of a box around the box or ball
  double radius = std::numeric_limits<double>::infinity();  // radius of the ball that contains all copies; infinite without a ball
};

Region region_of(const CopiesOptions& how, const std::optional<stokes::PeriodicCell>& cell) {
  switch (how.region()) {
    case CopiesOptions::Region::box: return {how.box->prod(), *how.box / 2};
    case CopiesOptions::Region::ball: return {ball_volume(*how.ball), Vec3::Constant(*how.ball), *how.ball};
    case CopiesOptions::Region::cell: return {volume_of(cell.value())};
  }
  throw std::logic_error("this region of copies is unknown");
}

/// Returns copies at random positions in a box or ball. Draws positions one by one and discards a position that is too close to a sphere in `taken`
/// or to one of its images on the lattice of `cell`, if given. Adds the spheres of the copies to `taken`.
std::vector<Copy> at_random(const CopiesOptions& how, int number, double radius, const Vec3& origin, const std::optional<stokes::PeriodicCell>& cell,
                            std::vector<PackedSphere>& taken, const std::string& list) {
  std::mt19937_64 random(static_cast<std::uint64_t>(how.seed));
  const Region region = region_of(how, cell);
  const Vec3& half = region.half_sides;
  if ((half.array() < radius).any())
    throw UserError(formatted("%s: a particle of radius %g does not fit into the box or ball of the copies; give a larger one.", list.c_str(),
                              radius));
  PackedSphere largest{origin, radius};
  for (const PackedSphere& one : taken) largest.radius = std::max(largest.radius, one.radius);
  const std::vector<Vec3> images = cell ? images_within(*cell, least_distance(largest, largest, how.least_gap)) : std::vector<Vec3>{Vec3::Zero()};
  std::vector<Copy> copies;
  const long most = 20000L * number;
  for (long trial = 0; static_cast<int>(copies.size()) < number; ++trial) {
    if (trial == most)
      throw UserError(
          formatted("%s: not all copies fit: %zu of %d were placed in %ld trials; give fewer copies, a larger box or ball, or "
                    "a smaller `least gap`.",
                    list.c_str(), copies.size(), number, most));
    Vec3 place;
    for (int c = 0; c < 3; ++c) place[c] = (2 * uniform(random) - 1) * (half[c] - radius);
    if (place.norm() > region.radius - radius) continue;
    const PackedSphere here{origin + place, radius, how.least_gap, true};
    const auto meets = [&](const PackedSphere& other) {
      const Vec3 apart = here.centre - other.centre, nearest = cell ? Vec3(apart - cell->shift(apart)) : apart;
      const double least = least_distance(here, other, how.least_gap);
      return std::ranges::any_of(images, [&](const Vec3& image) { return (nearest + image).norm() < least; });
    };
    if (std::ranges::any_of(taken, meets)) continue;
    taken.push_back(here);
    copies.push_back({place});
  }
  return copies;
}

/// Returns the number of copies on the lattice or at random positions. Throws UserError if the number is too large, or if it follows from a volume
/// fraction and the volume of a particle is not known.
int count(const CopiesOptions& how, const surface::ParticleShape& shape, const std::optional<stokes::PeriodicCell>& cell, const std::string& list) {
  constexpr double most = 1e6;
  double number = 0;
  if (how.lattice) {
    number = how.lattice->prod();
  } else if (how.number) {
    number = *how.number;
  } else {
    const std::optional<double> of_one = shape.exact_volume();
    if (!of_one)
      throw UserError(list + "/volume fraction cannot be used with Particle/initial shape/volume `own` and a shape from a file or run, because the "
                             "volume of a copy is not known when copies are counted: give `number`.");
    number = std::max(1.0, std::round(*how.volume_fraction * region_of(how, cell).volume / *of_one));
  }
  if (number > most)
    throw UserError(list + formatted(" may ask for at most %.0f copies, because more surfaces do not fit into memory, but asks for %.0f.", most,
                                     number));
  return static_cast<int>(number);
}

/// Adds spheres at random positions in the periodic cell to `taken`, and returns as many copies without positions. The spheres may overlap until
/// pack() separates them. Skips as many random numbers as earlier spheres have used, because earlier kinds of particles may have the same seed.
std::vector<Copy> in_cell(const CopiesOptions& how, int number, double radius, const Vec3& origin, const stokes::PeriodicCell& cell,
                          std::vector<PackedSphere>& taken) {
  std::mt19937_64 random(static_cast<std::uint64_t>(how.seed));
  random.discard(3 * static_cast<unsigned long long>(std::ranges::count(taken, false, &PackedSphere::fixed)));
  for (int k = 0; k < number; ++k) {
    Vec3 place;
    for (int c = 0; c < 3; ++c) place[c] = uniform(random) - 0.5;
    taken.push_back({origin + cell.vectors() * place, radius, how.least_gap, false});
  }
  return std::vector<Copy>(static_cast<std::size_t>(number));
}

/// Returns the copies of a kind of particle and adds their circumscribed spheres to `taken`. Throws UserError if the size of the particle is unknown.
std::vector<Copy> places(const ParticleKind& kind, const std::optional<stokes::PeriodicCell>& cell, std::vector<PackedSphere>& taken) {
  const CopiesOptions& how = kind.copies;
  const surface::ParticleShape& shape = kind.particle.shape;
  const std::string list = kind.path() + "/copies";
  try {
    if (!shape.sized()) shape.check();
    if (shape.initial) shape.initial->check();
  } catch (const UserError& error) {
    throw UserError(kind.path() + ": " + error.what());
  }
  const double radius = shape.circumscribed_radius();
  if (!how.present) {
    taken.push_back({shape.center, radius, 0, true});
    return {};
  }
  how.check(list, cell && cell->n() == 3);
  const int number = how.file ? 0 : count(how, shape, cell, list);
  if (how.random()) {
    if (how.in_cell()) return in_cell(how, number, radius, shape.center, cell.value(), taken);
    return at_random(how, number, radius, shape.center, cell, taken, list);
  }
  const std::vector<Copy> copies = how.file ? in_file(*how.file, list) : on_lattice(*how.lattice, *how.spacing);
  for (const Copy& copy : copies) taken.push_back({shape.center + copy.centre, radius, 0, true});
  return copies;
}

}  // namespace

void CopiesOptions::declare(deck::Section& section) {
  section.key("file", file,
              "path of a file with the positions of the copies of the particle, one row per copy: the centre x1,x2,x3 in the deck's unit "
              "of length, in all rows or in none followed by a rotation vector r1,r2,r3 in degrees. A first line may name the columns, in any "
              "order, and their units. A rotation turns the shape only: forces, torques and velocities of the copies keep their components "
              "along x1, x2, x3. A relative path is looked up in the working directory, then in the directory of the deck");
  section.key("lattice", lattice, deck::at_least(1), "1",
              "numbers of copies of the particle along x1, x2 and x3 on a rectangular lattice, which is centred at the particle's centre");
  section.key("spacing", spacing, deck::positive(), "length",
              "distances along x1, x2 and x3 between the centres of neighbouring copies of the particle on a `lattice`");
  section.key(
      "number", number, deck::at_least(1), "1",
      "number of copies of the particle at random positions in `box` or `ball`. If neither is given, the copies fill the cell of a Domain "
      "that is periodic in three directions, may cross its faces, and are distributed as hard spheres in thermal equilibrium. "
      "All copies have the orientation of the particle");
  section.key("volume fraction", volume_fraction, deck::between(0, 0.6), "1",
              "volume fraction of the copies of the particle in `box`, `ball` or the periodic cell, from which their number follows. At "
              "random positions, spheres reach a volume fraction of about 0.3 in `box` or `ball` and about 0.55 in the cell");
  section.key("box", box, deck::positive(), "length",
              "side lengths of a box that contains all copies of the particle at random positions; its centre is the key `center` of the particle");
  section.key("ball", ball, deck::positive(), "length",
              "radius of a ball that contains all copies of the particle at random positions; its centre is the key `center` of the particle");
  section.key("least gap", least_gap, deck::not_negative(), "R",
              "smallest allowed gap between the circumscribed spheres of two particles when copies are placed at random, divided by the "
              "radius R of the larger of the two spheres");
  section.key("seed", seed, deck::at_least(0), "1",
              "seed of the random number generator for copies at random positions. Equal seeds give equal positions");
}

void CopiesOptions::check(const std::string& list, bool cell) const {
  const int ways = file.has_value() + lattice.has_value() + random();
  if (ways != 1) throw UserError(list + " must have one of `file`, `lattice`, and `number` or `volume fraction`.");
  if (number && volume_fraction)
    throw UserError(list + "/number and " + list + "/volume fraction contradict each other: give one of them.");
  if (lattice && !spacing) throw UserError(list + "/spacing is missing: the distance of centres along x1, x2 and x3.");
  if (spacing && !lattice) throw UserError(list + "/spacing belongs to a `lattice`.");
  if (lattice && !lattice->isApprox(lattice->array().round().matrix(), 0)) throw UserError(list + "/lattice must be three whole numbers.");
  if (!random() && (box || ball)) throw UserError(list + "/box and ball are for random positions: give `number` or `volume fraction`.");
  if (in_cell() && !cell)
    throw UserError(list + " needs a `box` or a `ball` for random positions, or a Domain that is periodic in three directions.");
  if (box && ball) throw UserError(list + "/box and " + list + "/ball contradict each other: give one of them.");
}

namespace {

/// Returns the copies of every kind of particle. Copies at random positions in the cell, of all kinds together, are moved by one call of pack() until
/// no two of them overlap.
std::vector<std::vector<Copy>> all_places(const std::vector<ParticleKind>& kinds, const std::optional<stokes::PeriodicCell>& cell) {
  std::vector<std::vector<Copy>> all;
  std::vector<PackedSphere> taken;
  for (const ParticleKind& kind : kinds) all.push_back(places(kind, cell, taken));
  const auto in_cell = std::ranges::find_if(kinds, [](const ParticleKind& kind) { return kind.copies.present && kind.copies.in_cell(); });
  if (in_cell == kinds.end()) return all;
  if (!pack(taken, *cell, static_cast<std::uint64_t>(in_cell->copies.seed))) {
    double volume = 0;
    for (const PackedSphere& one : taken) volume += ball_volume(one.radius);
    throw UserError(
        formatted("Particles/%s/copies: the circumscribed spheres of the particles fill %.3g of the cell and cannot be placed there "
                  "without overlap: give fewer copies, a larger cell, or a smaller `least gap`.",
                  in_cell->name.c_str(), volume / volume_of(*cell)));
  }
  auto sphere = taken.begin();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (!kinds[k].copies.present) ++sphere;
    for (Copy& copy : all[k]) copy.centre = (sphere++)->centre - kinds[k].particle.shape.center;
  }
  return all;
}

}  // namespace

std::vector<ParticleKind> with_copies(const std::vector<ParticleKind>& kinds, const DomainOptions& domain) {
  std::vector<ParticleKind> all;
  const std::vector<std::vector<Copy>> of_kinds = all_places(kinds, domain.cell());
  for (std::size_t number = 0; number < kinds.size(); ++number) {
    const ParticleKind& kind = kinds[number];
    const std::vector<Copy>& copies = of_kinds[number];
    if (!kind.copies.present) all.push_back(kind);
    for (std::size_t k = 0; k < copies.size(); ++k) {
      ParticleKind& one = all.emplace_back(kind);
      one.name += formatted(" %zu", k + 1);
      if (std::ranges::any_of(kinds, [&](const ParticleKind& other) { return !other.copies.present && other.name == one.name; }))
        throw UserError(formatted("Particles/%s has the name of copy %zu of Particles/%s, but results are stored by name: rename one of them.",
                                  one.name.c_str(), k + 1, kind.name.c_str()));
      one.copies = {};
      surface::ParticleShape& shape = one.particle.shape;
      shape.center += copies[k].centre;
      const Eigen::AngleAxisd turn = rotation(copies[k].orientation), turned(turn * rotation(shape.orientation));
      if (shape.initial) shape.initial->turn = turn.toRotationMatrix(), shape.initial->shift = shape.center - turn * kind.particle.shape.center;
      shape.orientation = turned.angle() * 180 / std::numbers::pi * turned.axis();
    }
  }
  return all;
}

}  // namespace tanktread
