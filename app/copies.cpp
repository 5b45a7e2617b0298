#include "app/copies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "app/scene.hpp"
#include "base/csv.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/text_file.hpp"

namespace tanktread {

namespace {

/// A copy's centre and orientation, a rotation vector in degrees.
struct Copy {
  Vec3 centre, orientation = Vec3::Zero();
};

/// A sphere around a particle.
struct Ball {
  Vec3 centre;
  double radius;
};

Eigen::AngleAxisd rotation(const Vec3& degrees) {
  const double angle = degrees.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle * std::numbers::pi / 180, degrees / angle) : Eigen::AngleAxisd(0, Vec3::UnitX());
}

std::vector<Copy> in_file(const std::string& file, const std::string& list) {
  const std::string name = list + "/file \"" + file + "\"";
  std::vector<Copy> copies;
  for (const CsvRow& row : csv_rows(text_of_file(file, name, 100'000'000), "x1")) {
    const std::string where = name + formatted(", line %d: ", row.line);
    if (row.fields.size() != 3 && row.fields.size() != 6)
      throw UserError(where + "a row holds a centre x1,x2,x3 and, or not, a rotation vector of three numbers in degrees, but this one holds " +
                      formatted("%zu %s.", row.fields.size(), row.fields.size() == 1 ? "entry" : "entries"));
    Copy& copy = copies.emplace_back();
    for (std::size_t c = 0; c < row.fields.size(); ++c)
      (c < 3 ? copy.centre : copy.orientation)[static_cast<Eigen::Index>(c % 3)] = csv_number(row.fields[c], where);
  }
  if (copies.empty()) throw UserError(name + " holds no row of a centre.");
  return copies;
}

/// About the origin.
std::vector<Copy> on_lattice(const Vec3& counts, const Vec3& spacing) {
  std::vector<Copy> copies;
  for (int i = 0; i < counts[0]; ++i)
    for (int j = 0; j < counts[1]; ++j)
      for (int k = 0; k < counts[2]; ++k) copies.push_back({(Vec3(i, j, k) - (counts - Vec3::Ones()) / 2).cwiseProduct(spacing)});
  return copies;
}

/// Between 0 and 1, the same with every standard library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Places that are drawn one after the other, of which those too close to an earlier one are thrown away.
std::vector<Copy> at_random(const CopiesOptions& how, int number, double radius, const Vec3& origin, std::vector<Ball>& taken,
                            const std::string& list) {
  std::mt19937_64 random(static_cast<std::uint64_t>(how.seed));
  const Vec3 half = how.box ? Vec3(*how.box / 2) : Vec3::Constant(*how.ball);
  std::vector<Copy> copies;
  const long most = 20000L * number;
  for (long trial = 0; static_cast<int>(copies.size()) < number; ++trial) {
    if (trial == most)
      throw UserError(formatted("%s: there is no room: %zu of %d were placed in %ld trials; give fewer, more room, or a smaller `least gap`.",
                                list.c_str(), copies.size(), number, most));
    Vec3 place;
    for (int c = 0; c < 3; ++c) place[c] = (2 * uniform(random) - 1) * (half[c] - radius);
    if (how.ball && place.norm() > *how.ball - radius) continue;
    const Ball here{origin + place, radius};
    const auto meets = [&](const Ball& other) {
      return (here.centre - other.centre).norm() < (radius + other.radius) + how.least_gap * std::max(radius, other.radius);
    };
    if (std::ranges::any_of(taken, meets)) continue;
    taken.push_back(here);
    copies.push_back({place});
  }
  return copies;
}

int count(const CopiesOptions& how, double of_one) {
  if (how.number) return *how.number;
  const double room = how.box ? how.box->prod() : 4 * std::numbers::pi / 3 * std::pow(*how.ball, 3);
  return std::max(1, static_cast<int>(std::lround(*how.volume_fraction * room / of_one)));
}

std::vector<Copy> places(const ParticleKind& kind, std::vector<Ball>& taken) {
  const CopiesOptions& how = kind.copies;
  const surface::ParticleShape& shape = kind.particle.shape;
  const std::string list = "Particles/" + kind.name + "/copies";
  const double radius = shape.circumscribed_radius();
  if (!how.present) {
    taken.push_back({shape.center, radius});
    return {};
  }
  how.check(list);
  if (how.number || how.volume_fraction) {
    const double of_one = 4 * std::numbers::pi / 3 * std::pow(shape.equivalent_radius(), 3);
    return at_random(how, count(how, of_one), radius, shape.center, taken, list);
  }
  const std::vector<Copy> copies = how.file ? in_file(*how.file, list) : on_lattice(*how.lattice, *how.spacing);
  for (const Copy& copy : copies) taken.push_back({shape.center + copy.centre, radius});
  return copies;
}

}  // namespace

void CopiesOptions::declare(deck::Section& section) {
  section.key("file", file, deck::Choice{},
              "comma-separated values: a copy a row, its centre x1,x2,x3 and, or not, a rotation vector of three numbers in degrees; the first row "
              "may name the columns; looked for where the program is started and beside the deck");
  section.key("lattice", lattice, deck::at_least(1), "1", "how many along x1, x2 and x3, about the particle's centre");
  section.key("spacing", spacing, deck::positive(), "length", "of the lattice, between centres");
  section.key("number", number, deck::at_least(1), "1", "how many at random in `box` or `ball`");
  section.key("volume fraction", volume_fraction, deck::between(0, 0.6), "1", "of `box` or `ball`, in place of their number");
  section.key("box", box, deck::positive(), "length", "side lengths of the box about the particle's centre that they lie in");
  section.key("ball", ball, deck::positive(), "length", "radius of the ball about the particle's centre that they lie in");
  section.key("least gap", least_gap, deck::not_negative(), "R",
              "between the spheres around two particles at random, over the radius R of the larger one");
  section.key("seed", seed, deck::at_least(0), "1", "of the random places: the same seed gives the same places");
}

void CopiesOptions::check(const std::string& list) const {
  const int ways = file.has_value() + lattice.has_value() + (number || volume_fraction);
  if (ways != 1) throw UserError(list + " must have one of `file`, `lattice`, and `number` or `volume fraction`.");
  if (number && volume_fraction) throw UserError(list + "/number and " + list + "/volume fraction contradict each other.");
  if (lattice && !spacing) throw UserError(list + "/spacing is missing: the distance of centres along x1, x2 and x3.");
  if (spacing && !lattice) throw UserError(list + "/spacing belongs to a `lattice`.");
  if (lattice && !lattice->isApprox(lattice->array().round().matrix(), 0)) throw UserError(list + "/lattice must be three whole numbers.");
  const bool random = number || volume_fraction;
  if (random != (box || ball))
    throw UserError(list + (random ? " needs a `box` or a `ball` for places at random." : "/box and ball are for places at random."));
  if (box && ball) throw UserError(list + "/box and " + list + "/ball contradict each other.");
}

std::vector<ParticleKind> with_copies(const std::vector<ParticleKind>& kinds) {
  std::vector<ParticleKind> all;
  std::vector<Ball> taken;
  for (const ParticleKind& kind : kinds) {
    const std::vector<Copy> copies = places(kind, taken);
    if (!kind.copies.present) all.push_back(kind);
    for (std::size_t k = 0; k < copies.size(); ++k) {
      ParticleKind& one = all.emplace_back(kind);
      one.name += formatted(" %zu", k + 1);
      one.copies = {};
      surface::ParticleShape& shape = one.particle.shape;
      shape.center += copies[k].centre;
      const Eigen::AngleAxisd turned(rotation(copies[k].orientation) * rotation(shape.orientation));
      shape.orientation = turned.angle() * 180 / std::numbers::pi * turned.axis();
    }
  }
  return all;
}

}  // namespace tanktread
