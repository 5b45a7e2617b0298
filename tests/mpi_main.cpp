// Defines main() for the tests of modules that use MPI, with the threads that OMP_NUM_THREADS requests.

#include <gtest/gtest.h>

#include "base/threads.hpp"
#include "system/parallel/ranks.hpp"

int main(int argc, char** argv) {
  const tanktread::coupling::Session session(&argc, &argv);
  tanktread::set_threads(tanktread::requested_threads(1));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
