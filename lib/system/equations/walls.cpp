#include "system/equations/walls.hpp"

#include <utility>

#include "system/solids/ducts/duct.hpp"

namespace tanktread::coupling {

void EliminatedWalls::answer(const BlockVector&, Given given, Sources& to) const {
  const bool with_empty = given == Given::included;
  if (!with_empty && to.load.size() == 0 && to.density.size() == 0) return;
  const auto clock = phases_.time("wall");
  to.walls = walls_.respond(to.load, to.density, with_empty);
}

DuctWall::DuctWall(Tube& tube, const Layout& unknowns, std::string form)
    : tube_(tube), form_(std::move(form)), traction_(unknowns.id("wall traction", -1)), drop_(unknowns.id("pressure drop", -1)),
      unit_(unknowns[drop_].unit) {}

std::vector<Block> DuctWall::unknowns(const Tube& tube, double viscosity) {
  const double unit = viscosity / tube.wall().radius();
  return {{.name = "wall traction", .rows = static_cast<Eigen::Index>(tube.wall().sites.size()), .unit = unit},
          {.name = "pressure drop", .rows = 1, .components = 1, .parity = Parity::scalar, .unit = unit}};
}

void DuctWall::answer(const BlockVector& x, Given, Sources& to) const {
  to.walls.emplace();
  Tube::Response& response = to.walls->tube = tube_.cause(to.load, to.density);
  response.caused_drop = std::exchange(response.pressure_drop, x.value(drop_)(0, 0));
  response.wall_traction = x.value(traction_);
  tube_.add_answer(response);
}

void DuctWall::add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity&, Given, BlockVector& r) const {
  const Tube::Response& response = from.walls->tube;
  r(traction_) += tube_.duct().residual(response.wall_traction, response.pressure_drop, response.on_wall);
  r(drop_)(0, 0) += x(drop_)(0, 0) - response.caused_drop / unit_;
}

void DuctWall::precondition(const BlockVector& r, BlockVector& x) const {
  if (form_ == "block") return;
  Net on_wall = r(traction_);
  double drop = 0;
  if (form_ == "block triangular") {
    const Tube::Response caused = tube_.cause({}, System::particles(std::as_const(x)));
    x(drop_)(0, 0) += caused.pressure_drop / unit_;
    on_wall += caused.on_wall, drop = x.value(drop_)(0, 0);
  }
  x.set(traction_, tube_.duct().traction(on_wall, drop));
}

}  // namespace tanktread::coupling
