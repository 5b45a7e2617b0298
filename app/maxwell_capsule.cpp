// A capsule in the time loop whose membrane's viscosity has a memory: the capsule alone, and what its Maxwell element adds.

#include "app/carrying_particle.hpp"
#include "membrane/maxwell_element.hpp"

namespace tanktread {

namespace {

class MaxwellCapsule : public CarryingParticle {
 public:
  MaxwellCapsule(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : CarryingParticle(scene, ranks, phases),
        element_(body().space, body().initial, capsule()->membrane().order(), scene.membrane.viscosity(), *scene.membrane.relaxation_time) {
    carry(element_);
  }

 private:
  void complete(std::vector<double>& row, const Eigen::VectorXd&) override { row[column("membrane_dissipation")] += element_.dissipation(); }

  membrane::MaxwellElement element_;
};

}  // namespace

std::unique_ptr<ParticleSystem> maxwell_capsule(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<MaxwellCapsule>(scene, ranks, phases);
}

}  // namespace tanktread
