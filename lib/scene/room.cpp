#include "scene/room.hpp"

#include "base/formatted.hpp"

namespace tanktread {

void refine(ParticleKind& kind, int factor) {
  for (auto* elements : {&kind.surface.elements_per_side, &kind.surface.azimuthal_elements, &kind.surface.meridional_elements})
    if (*elements) **elements *= factor;
  if (kind.surface.n_points() > 2e4) throw UserError("this mesh takes too long to build for a check");  // see check_room()
}

void check_room(const std::function<void(int factor)>& check, bool adapts) {
  constexpr int finest = 8;
  try {
    check(1);
  } catch (const NoRoom& here) {
    for (int factor = 2; factor <= finest; factor *= 2) {
      std::string there = "there is room.";
      try {
        check(factor);
        if (here.gap > 0 && adapts) return;
      } catch (const NoRoom& finer) {
        if (here.gap > 0) break;
        if (finer.gap <= 0) continue;
        there = finer.what();
      } catch (const UserError&) {
        break;
      }
      throw UserError(formatted("The meshes are too coarse: %s With %d times as many elements in each direction (Surface): %s", here.what(), factor,
                                there.c_str()));
    }
    throw;
  }
}

}  // namespace tanktread
