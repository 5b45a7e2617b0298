# module(FOLDER [USES module...] [EXTERNAL library...]): makes the library tanktread_NAME from the files in lib/FOLDER, which may include the
# modules and libraries named. NAME is FOLDER with _ instead of /.
#
# Files *_kernel.cpp contain plain loops over arrays, in which the compiler may reorder sums and replace divisions by products. If the program is
# built for any x86-64 processor, each of these files is compiled for several instruction sets (base/kernel.hpp), with -fno-weak: inline functions
# and templates of headers stay in the object file, because the linker must not use a function with AVX-512 instructions in place of another file's
# function. NaN and infinity keep their meaning (-fno-finite-math-only), because a run that goes wrong must be noticed. Under the sanitizers -O3
# takes ten times as long to compile.
set(kernel_flags $<IF:$<CONFIG:Sanitized>,-O2,-O3> -ffast-math -fno-finite-math-only)
set(instruction_sets)
if(SEVERAL_INSTRUCTION_SETS)
  set(instruction_sets avx2 avx512)
  set(flags_of_avx2 -march=x86-64-v3)
  set(flags_of_avx512 -march=x86-64-v4 -mprefer-vector-width=512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND kernel_flags -mprefer-vector-width=512)
endif()

# Precompiled headers, which nearly every file includes; they save a third of the compile time. Files still include what they use, as a build with
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp CONTENT "")
add_library(headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp)
target_link_libraries(headers PRIVATE Eigen3::Eigen)
set(common_headers <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <set> <span> <string> <vector>
  <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <Eigen/SparseCore>)
set_property(GLOBAL PROPERTY common_headers ${common_headers})
target_precompile_headers(headers PRIVATE ${common_headers})

function(module folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;EXTERNAL")
  string(REPLACE / _ name ${folder})
  string(REPLACE / _ modules "${arg_USES}")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  get_property(folders GLOBAL PROPERTY folders)
  foreach(other ${folders}) # modules in subfolders come first
    list(FILTER sources EXCLUDE REGEX "/lib/${other}/")
  endforeach()
  list(TRANSFORM modules PREPEND tanktread_)
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
  target_link_libraries(tanktread_${name} ${visibility} ${modules} Eigen3::Eigen)
  set_property(GLOBAL PROPERTY externals_of_${name} ${externals}) # for the module's unit tests
  set_property(GLOBAL APPEND PROPERTY modules ${name})
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
      target_link_libraries(tanktread_${name}_${set} PRIVATE ${modules} ${externals} Eigen3::Eigen)
      target_sources(tanktread_${name} PRIVATE $<TARGET_OBJECTS:tanktread_${name}_${set}>)
    endforeach()
    if(instruction_sets)
      target_compile_definitions(tanktread_${name} PRIVATE SEVERAL_INSTRUCTION_SETS)
    endif()
  endif()
endfunction()
