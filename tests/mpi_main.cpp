// The main() of tests of rooms that communicate.

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  Tpetra::ScopeGuard mpi(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
