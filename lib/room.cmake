# room(FOLDER [USES room…] [EXTERNAL library…]): library tanktread_NAME from the files below lib/FOLDER, which may use just the rooms and libraries
# named. NAME is FOLDER with _ for /.
#
# Files *_kernel.cpp hold plain loops over arrays; there sums may be reordered and divisions turned into products. Where the program is built for
# any processor of the family x86-64, each is compiled for several sets of instructions (base/kernel.hpp), with -fno-weak: what a header brings along,
# inline or as a template, stays in the object, for the linker must not take a function with AVX-512 for that of another file.
# NaN and infinity keep their meaning (-fno-finite-math-only): a run that goes wrong must still be noticed.
# So do comparisons with them; what a kernel may not rely on is the last bit of a sum. With the checks of sanitizers between, -O3 takes ten times as long.
set(kernel_flags $<IF:$<CONFIG:Sanitized>,-O2,-O3> -ffast-math -fno-finite-math-only)
set(instruction_sets)
if(SEVERAL_INSTRUCTION_SETS)
  set(instruction_sets avx2 avx512)
  set(flags_of_avx2 -march=x86-64-v3)
  set(flags_of_avx512 -march=x86-64-v4 -mprefer-vector-width=512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND kernel_flags -mprefer-vector-width=512)
endif()

# What nearly every file reads first, compiled once: a third of the time to compile a file. Files still include what they use, which a build with
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp CONTENT "")
add_library(headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp)
target_link_libraries(headers PRIVATE Eigen3::Eigen)
set(common_headers <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <set> <span> <string> <vector>
  <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <Eigen/SparseCore>)
set_property(GLOBAL PROPERTY common_headers ${common_headers})
target_precompile_headers(headers PRIVATE ${common_headers})

function(room folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;EXTERNAL")
  string(REPLACE / _ name ${folder})
  string(REPLACE / _ rooms "${arg_USES}")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  get_property(folders GLOBAL PROPERTY folders)
  foreach(other ${folders}) # rooms in subfolders stand above
    list(FILTER sources EXCLUDE REGEX "/lib/${other}/")
  endforeach()
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
  target_include_directories(tanktread_${name} ${visibility} $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/tanktread>)
  target_link_libraries(tanktread_${name} ${visibility} ${rooms} Eigen3::Eigen)
  set_property(GLOBAL PROPERTY externals_of_${name} ${externals}) # for the room's unit tests
  set_property(GLOBAL APPEND PROPERTY rooms ${name})
  set_property(GLOBAL APPEND PROPERTY folders ${folder})

  set(kernels ${sources})
  list(FILTER kernels INCLUDE REGEX "_kernel\\.cpp$")
  if(kernels)
    set_source_files_properties(${kernels} PROPERTIES COMPILE_OPTIONS "${kernel_flags}" SKIP_PRECOMPILE_HEADERS ON)
    foreach(set ${instruction_sets})
      add_library(tanktread_${name}_${set} OBJECT ${kernels})
      target_compile_options(tanktread_${name}_${set} PRIVATE ${flags_of_${set}} -fno-weak -w) # the first compilation warns
      target_compile_definitions(tanktread_${name}_${set} PRIVATE INSTRUCTIONS=${set} ONE_OF_SEVERAL_INSTRUCTION_SETS)
      target_include_directories(tanktread_${name}_${set} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
      target_link_libraries(tanktread_${name}_${set} PRIVATE ${rooms} ${externals} Eigen3::Eigen)
      target_sources(tanktread_${name} PRIVATE $<TARGET_OBJECTS:tanktread_${name}_${set}>)
    endforeach()
    if(instruction_sets)
      target_compile_definitions(tanktread_${name} PRIVATE SEVERAL_INSTRUCTION_SETS)
    endif()
  endif()
endfunction()
