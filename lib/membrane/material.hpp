#pragma once
// What membranes are made of.

#include <vector>

#include "membrane/bending.hpp"
#include "membrane/laws.hpp"

namespace tanktread::membrane {

struct Material {
  Law law;
  Bending bending;
};

/// The materials of a surface, and which of them each element is of.
struct Materials {
  std::vector<Material> all;
  std::vector<int> of_element;  ///< none where there is one material

  bool bend() const {
    for (const Material& material : all)
      if (material.bending.modulus > 0) return true;
    return false;
  }
};

}  // namespace tanktread::membrane
