#include "accuracy/obstacles.hpp"

namespace tanktread::accuracy {

std::string obstacle_of(std::string_view kind) {
  if (kind.ends_with(full_mesh)) return "the mesh has reached Adaptation/largest number of points: increase it";
  if (kind.ends_with(wrinkles))
    return "the membrane is compressed and resists bending too little for its mesh, so that wrinkles can have grown that the mesh does not represent";
  return {};
}

}  // namespace tanktread::accuracy
