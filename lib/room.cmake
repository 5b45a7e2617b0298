# room(NAME [USES room…] [EXTERNAL library…]): library tanktread_NAME from lib/NAME/*.cpp, which may use just the rooms and libraries named.
#
# Files *kernel*.cpp hold plain loops over arrays; there sums may be reordered and divisions turned into products.
# NaN and infinity keep their meaning (-fno-finite-math-only): a run that goes wrong must still be noticed.
# So do comparisons with them; what a kernel may not rely on is the last bit of a sum.
set(kernel_flags -O3 -ffast-math -fno-finite-math-only -mprefer-vector-width=512)

function(room name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;EXTERNAL")
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  set(rooms ${arg_USES})
  list(TRANSFORM rooms PREPEND tanktread_)
  set(externals ${arg_EXTERNAL})
  list(TRANSFORM externals PREPEND external_)

  if(sources)
    add_library(tanktread_${name} STATIC ${sources})
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
    set_source_files_properties(${kernels} PROPERTIES COMPILE_OPTIONS "${kernel_flags}")
  endif()
endfunction()
