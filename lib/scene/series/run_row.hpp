#pragma once
// Data of a run as a whole for one row of the results.

#include "base/columns.hpp"
#include "scene/domain.hpp"
#include "scene/particles/gaps.hpp"
#include "scene/plane_wall.hpp"
#include "scene/scene.hpp"
#include "scene/series/diagnostics.hpp"
#include "scene/series/series.hpp"
#include "scene/solids.hpp"
#include "scene/tube.hpp"
#include "system/contact.hpp"
#include "system/power_balance.hpp"

namespace tanktread {

/// Data of a run as a whole. A run sets the members that its scene has. The scene determines which of them become columns, so that every row and the
/// manual have the same columns (run_columns). Columns of single particles and of user-defined series are added separately.
struct RunRow {
  ProgressRow progress;
  TubeRow tube;
  WallRow wall;
  SolidsRow solids;
  DomainRow domain;
  Together together;
  coupling::Powers powers;
  Nearest nearest;
  coupling::Contacts contacts;  ///< contacts that hold particles apart
  void add_columns(const Scene& scene, Columns& to) const;
};

}  // namespace tanktread
