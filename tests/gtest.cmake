# The headers of GoogleTest and of the rooms, compiled once for all programs.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp CONTENT "")
add_library(test_headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
find_package(Eigen3 REQUIRED NO_MODULE)
target_link_libraries(test_headers PRIVATE Eigen3::Eigen GTest::gtest)
target_precompile_headers(test_headers PRIVATE <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <set> <span> <string> <vector>
  <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <Eigen/SparseCore> <gtest/gtest.h>)

# gtest_program(NAME KIND kind SOURCES … ROOMS … [MPI]): one GoogleTest program, one ctest entry a TEST, with the label `kind`.
# Suites whose names end in Long carry the label `long`. MPI: main() initialises MPI, and the whole program runs once more on two ranks.
function(gtest_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "MPI" "KIND" "SOURCES;ROOMS")
  add_executable(${name} ${arg_SOURCES})
  foreach(room ${arg_ROOMS})
    get_property(externals GLOBAL PROPERTY externals_of_${room})
    target_link_libraries(${name} PRIVATE tanktread_${room} ${externals})
  endforeach()
  target_precompile_headers(${name} REUSE_FROM test_headers)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE SOURCE_DIRECTORY="${PROJECT_SOURCE_DIR}")
  if(arg_MPI)
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/mpi_main.cpp)
    target_link_libraries(${name} PRIVATE GTest::gtest external_TRILINOS)
  else()
    target_link_libraries(${name} PRIVATE GTest::gtest_main)
  endif()

  discover(${name} short "-*Long.*" "${arg_KIND}")
  discover(${name} long "*Long.*" "${arg_KIND};long")
  if(arg_MPI)
    add_test(NAME ${name}.on_two_ranks COMMAND ${MPIEXEC_EXECUTABLE} -n 2 $<TARGET_FILE:${name}> --gtest_filter=-*Long.*)
    set_tests_properties(${name}.on_two_ranks PROPERTIES LABELS "${arg_KIND};mpi" PROCESSORS 2 ENVIRONMENT "${run_environment}")
  endif()
endfunction()

# One ctest entry for each test of the program that passes the filter. gtest_discover_tests flattens properties that are lists,
# so those are set by a file that ctest reads afterwards.
function(discover name selection filter labels)
  set(list ${name}_${selection}_TESTS)
  gtest_discover_tests(${name} TEST_PREFIX ${name}. TEST_FILTER "${filter}" TEST_LIST ${list} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${name}_${selection}_properties.cmake)
  file(WRITE ${file} "if(${list})
  set_tests_properties(\${${list}} PROPERTIES LABELS \"${labels}\" ENVIRONMENT \"${run_environment}\")
endif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()
