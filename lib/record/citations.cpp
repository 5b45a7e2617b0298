#include "record/citations.hpp"

#include <algorithm>
#include <array>

namespace tanktread {

namespace {

/// Returns true if `used` holds for a deforming particle of the scene.
bool any_membrane(const Scene& scene, bool (*used)(const membrane::Options& options)) {
  return std::ranges::any_of(scene.particles, [used](const ParticleKind& one) { return !one.particle.rigid() && used(one.membrane); });
}

struct Citation {
  const char *feature, *publication;
  bool (*used)(const Scene& scene);
};

// Publications that comments of the library name as sources. Only publications whose title, or journal with volume and year, is known are listed.
constexpr std::array<Citation, 9> all{{
    {"method",
     "J. Maestre, J. Pallares, I. Cuesta, M. A. Scott: A 3D isogeometric BE-FE analysis with dynamic remeshing for the simulation of a deformable "
     "particle in shear flows. Comput. Methods Appl. Mech. Engrg. 326, 70-101, 2017.",
     [](const Scene&) { return true; }},
    {"boundary integrals", "C. Pozrikidis: Boundary Integral and Singularity Methods for Linearized Viscous Flow. Cambridge University Press, 1992.",
     [](const Scene&) { return true; }},
    {"particle stresslet", "G. K. Batchelor: The stress system in a suspension of force-free particles. J. Fluid Mech. 41, 545-570, 1970.",
     [](const Scene& scene) { return !scene.tube.present; }},
    {"law Mooney-Rivlin", "D. Barthes-Biesel, A. Diaz, E. Dhenin: Effect of constitutive laws for two-dimensional membranes on flow-induced capsule "
     "deformation. J. Fluid Mech. 460, 211-222, 2002.",
     [](const Scene& scene) { return any_membrane(scene, [](const membrane::Options& options) { return options.law == "Mooney-Rivlin"; }); }},
    {"law Evans-Skalak", "E. A. Evans, R. Skalak: Mechanics and Thermodynamics of Biomembranes. 1980.",
     [](const Scene& scene) { return any_membrane(scene, [](const membrane::Options& options) { return options.law == "Evans-Skalak"; }); }},
    {"surface viscosity", "D. Barthes-Biesel, H. Sgaier: J. Fluid Mech. 160, 1985.",
     [](const Scene& scene) { return any_membrane(scene, [](const membrane::Options& options) { return options.viscosity.any(); }); }},
    {"lattice", "H. Hasimoto: On the periodic fundamental solutions of the Stokes equations and their application to viscous flow past a cubic array "
     "of spheres. J. Fluid Mech. 5, 317, 1959.",
     [](const Scene& scene) { return scene.domain.present; }},
    {"lattice", "D. Lindbo, A.-K. Tornberg: J. Comput. Phys. 229, 8994-9010, 2010.", [](const Scene& scene) { return scene.domain.present; }},
    {"clusters of far sums", "L. Wang, R. Krasny, S. Vaughn: A kernel-independent treecode based on barycentric Lagrange interpolation. Commun. "
     "Comput. Phys. 28, 2020.",
     [](const Scene& scene) { return scene.quadrature.rule == quadrature::LayerRule::adaptive && scene.quadrature.far_sum != "dense"; }},
}};

}  // namespace

std::string citations(const Scene* scene, const std::string& version) {
  std::string text = "program: tanktread " + version + " (CITATION.cff)\n";
  for (const Citation& citation : all)
    if (!scene || citation.used(*scene)) text += std::string(citation.feature) + ": " + citation.publication + "\n";
  return text;
}

}  // namespace tanktread
