// Defines main() for the tests of modules that use MPI.

#include <gtest/gtest.h>

#include "system/parallel/ranks.hpp"

int main(int argc, char** argv) {
  const tanktread::coupling::Session session(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
