// Defines main() for the tests of modules that do not use MPI, with the threads that OMP_NUM_THREADS requests.

#include <gtest/gtest.h>

#include "base/threads.hpp"

int main(int argc, char** argv) {
  tanktread::set_threads(tanktread::requested_threads(1));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
