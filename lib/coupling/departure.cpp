#include "coupling/departure.hpp"

#include <chrono>
#include <cstdio>
#include <thread>

#include <mpi.h>

namespace tanktread::coupling {

void leave_together(int code, const std::string& message) {
  constexpr std::chrono::seconds patience(30);
  int parallel = 0, ranks = 1, rank = 0, here = 0;
  MPI_Initialized(&parallel);
  if (!parallel) return;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (ranks == 1) return;
  MPI_Request all;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  const auto start = std::chrono::steady_clock::now();
  while (MPI_Test(&all, &here, MPI_STATUS_IGNORE), !here) {
    if (code > 1 && std::chrono::steady_clock::now() - start > patience) {
      if (rank > 0) std::fprintf(stderr, "tanktread: rank %d: %s\n", rank, message.c_str());
      MPI_Abort(MPI_COMM_WORLD, code);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace tanktread::coupling
