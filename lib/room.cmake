# room(NAME [USES room…] [EXTERNAL library…]): library tanktread_NAME from lib/NAME/*.cpp, which may use just the rooms and libraries named.
#
# Files *kernel*.cpp hold plain loops over arrays; there sums may be reordered and divisions turned into products.
# NaN and infinity keep their meaning (-fno-finite-math-only): a run that goes wrong must still be noticed.
# So do comparisons with them; what a kernel may not rely on is the last bit of a sum.
set(kernel_flags -O3 -ffast-math -fno-finite-math-only -mprefer-vector-width=512)

# What nearly every file reads first, compiled once: a third of the time to compile a file. Files still include what they use, which a build with
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp CONTENT "")
add_library(headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp)
target_link_libraries(headers PRIVATE Eigen3::Eigen)
target_precompile_headers(headers PRIVATE <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <set> <span> <string> <vector>
  <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <Eigen/SparseCore>)

function(room name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;EXTERNAL")
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  set(rooms ${arg_USES})
  list(TRANSFORM rooms PREPEND tanktread_)
  set(externals ${arg_EXTERNAL})
  list(TRANSFORM externals PREPEND external_)

  if(sources)
    add_library(tanktread_${name} STATIC ${sources})
    target_precompile_headers(tanktread_${name} REUSE_FROM headers)
    set(visibility PUBLIC)
    target_link_libraries(tanktread_${name} PRIVATE ${externals})
  else()
    add_library(tanktread_${name} INTERFACE)
    set(visibility INTERFACE)
  endif()
  target_include_directories(tanktread_${name} ${visibility} ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(tanktread_${name} ${visibility} ${rooms} Eigen3::Eigen)
  set_property(GLOBAL PROPERTY externals_of_${name} ${externals}) # for the room's unit tests
  set_property(GLOBAL APPEND PROPERTY rooms ${name})

  set(kernels ${sources})
  list(FILTER kernels INCLUDE REGEX "/${name}/[^/]*kernel[^/]*\\.cpp$")
  if(kernels)
    set_source_files_properties(${kernels} PROPERTIES COMPILE_OPTIONS "${kernel_flags}" SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()
