// A drop with surfactant in the time loop: the drop alone, and what its surfactant adds.

#include "app/carrying_particle.hpp"
#include "app/series.hpp"
#include "membrane/surfactant.hpp"
#include "output/nodes.hpp"

namespace tanktread {

namespace {

class SurfactantDrop : public CarryingParticle {
 public:
  SurfactantDrop(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : CarryingParticle(scene, ranks, phases),
        surfactant_(body().space, body().initial, *scene.surfactant, scene.modulus(),
                    scene.surfactant->diffusivity_of(scene.flow.rate(), scene.radius())) {
    carry(surfactant_);
  }

 private:
  void complete(std::vector<double>& row, const Eigen::VectorXd& q) override {
    row[column("smallest_tension")] = scene().surfactant->tension(surfactant_.largest());
    Moment now;
    now.surfactant_mass = surfactant_.mass(q);
    now.smallest_concentration = surfactant_.smallest(), now.largest_concentration = surfactant_.largest();
    const std::vector<double> of_this = tanktread::row(series(scene(), of_surfactant), now);
    row.insert(row.end(), of_this.begin(), of_this.end());
  }

  void complete(SurfacePicture& picture) override {
    const auto of_shape = picture.fields;
    picture.fields = [of_shape, options = *scene().surfactant, concentration = surfactant_.concentration()](const output::Nodes& nodes) {
      std::vector<output::Field> fields = of_shape(nodes);
      const Eigen::VectorXd c = nodes.values(concentration.replicate(1, 3)).col(0);
      for (output::Field& field : fields)
        if (field.name == "smallest tension" || field.name == "largest tension")
          field.values = c.unaryExpr([&](double here) { return options.tension(here); });
      fields.push_back({"concentration", c});
      return fields;
    };
  }

  membrane::Surfactant surfactant_;
};

}  // namespace

std::unique_ptr<ParticleSystem> surfactant_drop(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<SurfactantDrop>(scene, ranks, phases);
}

}  // namespace tanktread
