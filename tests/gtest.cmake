# gtest_program(NAME KIND kind SOURCES … ROOMS … [MPI]): one GoogleTest program, one ctest entry a TEST, with the label `kind`.
# Suites whose names end in Long carry the label `long`. MPI: main() initialises MPI, and the whole program runs once more on two ranks.
function(gtest_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "MPI" "KIND" "SOURCES;ROOMS")
  add_executable(${name} ${arg_SOURCES})
  foreach(room ${arg_ROOMS})
    get_property(externals GLOBAL PROPERTY externals_of_${room})
    target_link_libraries(${name} PRIVATE tanktread_${room} ${externals})
  endforeach()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE SOURCE_DIRECTORY="${PROJECT_SOURCE_DIR}")
  if(arg_MPI)
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/mpi_main.cpp)
    target_link_libraries(${name} PRIVATE GTest::gtest external_TRILINOS)
  else()
    target_link_libraries(${name} PRIVATE GTest::gtest_main)
  endif()

  set(discovery DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(${name} TEST_PREFIX ${name}. TEST_FILTER "-*Long.*" ${discovery}
    PROPERTIES LABELS ${arg_KIND} ENVIRONMENT "${run_environment}")
  gtest_discover_tests(${name} TEST_PREFIX ${name}. TEST_FILTER "*Long.*" ${discovery}
    PROPERTIES LABELS "${arg_KIND};long" ENVIRONMENT "${run_environment}")
  if(arg_MPI)
    add_test(NAME ${name}.on_two_ranks COMMAND ${MPIEXEC_EXECUTABLE} -n 2 $<TARGET_FILE:${name}> --gtest_filter=-*Long.*)
    set_tests_properties(${name}.on_two_ranks PROPERTIES LABELS "${arg_KIND};mpi" PROCESSORS 2 ENVIRONMENT "${run_environment}")
  endif()
endfunction()
