#pragma once
// Differences between the versions of libraries that the supported systems have. Names here are those of the oldest version (Debian 12).

#include <Eigen/Core>

#define H5_USE_110_API  // HDF5 1.12 and later: the functions of HDF5 1.10

#if EIGEN_VERSION_AT_LEAST(3, 4, 90)
namespace Eigen {
using placeholders::all, placeholders::last;
}
#endif
