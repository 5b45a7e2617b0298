#include "deck/words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace tanktread::deck {

namespace {

/// Returns the name in lower case, with a blank for each character other than a letter, a digit or `/`: `t_end`, `t-end` and `T end` become equal.
std::string plain(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    out += std::isalnum(byte) || c == '/' ? static_cast<char>(std::tolower(byte)) : ' ';
  }
  return out;
}

struct Meaning {
  std::string_view names;  ///< alternative names, each between bars
  std::string_view what;
};

constexpr std::array<Meaning, 32> synonyms{{
    {"|capsules|cells|drops|bodies|number of particles|number of capsules|n particles|suspension|hematocrit|haematocrit|volume fraction|",
     "Particles"},
    {"|dt|delta t|time step|timestep|step|step size|stepsize|", "Time/fixed step or Time/initial step"},
    {"|tend|t end|end time|end|tfinal|t final|tmax|t max|max time|maximum time|stop time|duration|simulation time|", "Time/final time"},
    {"|tol|rtol|atol|reltol|abstol|accuracy|error tolerance|", "Time/tolerance"},
    {"|integrator|time integrator|stepper|time stepping|method|time scheme|", "Time/scheme"},
    {"|ca|capillary|", "Membrane/capillary number"},
    {"|gs|g s|shear elasticity|elastic modulus|surface shear modulus|stiffness|young modulus|young s modulus|youngs modulus|es|e s|",
     "Membrane/shear modulus"},
    {"|sigma|interfacial tension|tension|", "Membrane/surface tension"},
    {"|c|nu|poisson ratio|poisson s ratio|poissons ratio|dilatation|area modulus|", "Membrane/area dilatation"},
    {"|kappa|kb|k b|kappa b|eb|e b|bending|bending stiffness|bending rigidity|", "Membrane/bending modulus"},
    {"|spontaneous curvature|reference curvature|", "Membrane/bending reference"},
    {"|alpha|inflation|preinflation|prestress|pre stress|swelling|", "Membrane/pre-inflation"},
    {"|lambda|viscosity contrast|inner viscosity|viscosity inside|", "Particle/viscosity ratio"},
    {"|r|a|rc|r c|r0|diameter|size|", "Particle/radius"},
    {"|axes|semiaxes|aspect ratio|aspect|", "Particle/semi-axes"},
    {"|position|centre|location|x0|origin|offset|", "Particle/center"},
    {"|angle|rotation|tilt|euler angles|inclination|", "Particle/orientation"},
    {"|mu|eta|dynamic viscosity|outer viscosity|viscosity outside|", "Flow/viscosity"},
    {"|gamma|gammadot|gamma dot|shear|rate|strain rate|", "Flow/shear rate"},
    {"|q|volumetric flow rate|volume flow|volume flow rate|flowrate|pump rate|", "Flow/flow rate"},
    {"|velocity gradient|gradu|grad u|gradient tensor|", "Flow/gradient"},
    {"|mesh size|h|n|resolution|elements|number of elements|n elements|refinement|refinement level|subdivisions|element size|",
     "Surface/elements per side"},
    {"|save every|save interval|snapshot interval|output interval|output frequency|frequency|dump|dt out|output every|", "Output/interval"},
    {"|output dir|output directory|outdir|directory|dir|folder|output folder|", "--output of the command line"},
    {"|g|acceleration|", "Flow/gravity"},
    {"|density|rho|density ratio|buoyancy|body force|excess density|bond number|", "Particle/density difference"},
    {"|restart|resume|continue|", "--resume of the command line"},
    {"|period|box|box size|unit cell|periodicity|", "Domain"},
    {"|membrane viscosity|surface viscosity|shear surface viscosity|boussinesq number|membrane/viscosity|", "Membrane/shear viscosity"},
    {"|wall|walls|plane wall|plane|plates|", "Wall"},
    {"|surfactant|surfactants|marangoni|marangoni number|surfactant concentration|", "the section Interface/surfactant"},
    {"|elasticity number|", "Interface/surfactant/elasticity number"},
}};

/// Features that the program does not have. A key or section is looked up by its full path, or by its name without the path.
constexpr std::array<Meaning, 8> features{{
    {"|re|reynolds|reynolds number|inertia|", "inertia is not available; the program computes Stokes flow, at Reynolds number 0"},
    {"|order|degree|polynomial degree|polynomial order|spline order|spline degree|p|",
     "the degree of the splines cannot be chosen; the accuracy is set by the mesh, Surface/elements per side"},
    {"|temperature|brownian|thermal noise|noise|kbt|", "Brownian motion is not available"},
    {"|adhesion|adhesion energy|", "adhesion is not available"},
    {"|electric field|magnetic field|charge|", "electric and magnetic fields are not available"},
    {"|porosity|permeability|", "permeable membranes are not available"},
    {"|rupture|breakup|break up|plasticity|", "break-up, rupture and plasticity are not available"},
    {"|power law index|carreau|weissenberg number|", "non-Newtonian fluids are not available"},
}};

std::string looked_up(const auto& table, const std::string& name) {
  const auto found = std::ranges::find_if(table, [&](const Meaning& m) { return m.names.find("|" + name + "|") != m.names.npos; });
  return found == table.end() ? std::string() : std::string(found->what);
}

}  // namespace

std::string synonym(const std::string& name) { return looked_up(synonyms, plain(name)); }

std::string missing_feature(const std::string& path) {
  const std::string whole = plain(path);
  std::string what = looked_up(features, whole);
  if (what.empty()) what = looked_up(features, whole.substr(whole.rfind('/') + 1));
  return what.empty() ? what : what + " (README.md lists what the program can do)";
}

}  // namespace tanktread::deck
