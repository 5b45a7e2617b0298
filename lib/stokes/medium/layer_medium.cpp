#include "stokes/medium/layer_medium.hpp"

namespace tanktread::stokes {

void LayerMedium::set_sources(const LayerSources& /*sources*/) {}

void LayerMedium::share(int /*part*/, int /*parts*/) {}

void LayerMedium::add_remainder(const LayerSources& /*sources*/, std::span<const int> /*sites*/, Rows<double>& /*a*/) const {}

}  // namespace tanktread::stokes
