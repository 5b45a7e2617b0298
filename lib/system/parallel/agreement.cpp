#include "system/parallel/agreement.hpp"

#include <chrono>
#include <cstdio>
#include <new>
#include <thread>

#include <mpi.h>

#include "base/errors.hpp"
#include "base/stop.hpp"

namespace tanktread::coupling {

namespace {

constexpr std::chrono::seconds patience(30);

/// Returns the communicator of all ranks; null if there is only one rank.
MPI_Comm& everyone() {
  static MPI_Comm comm = MPI_COMM_NULL;
  return comm;
}

int rank() {
  int mine = 0;
  MPI_Comm_rank(everyone(), &mine);
  return mine;
}

/// Waits until all ranks have arrived at `request`. A rank that has an error waits only for `patience` and then ends all ranks.
void wait(MPI_Request& request, int code, const std::string& message) {
  const auto start = std::chrono::steady_clock::now();
  for (int here = 0; MPI_Test(&request, &here, MPI_STATUS_IGNORE), !here;) {
    const auto waited = std::chrono::steady_clock::now() - start;
    if (waited < std::chrono::milliseconds(10))
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (code > 0 && waited > patience) {
      if (!message.empty()) std::fprintf(stderr, "tanktread: rank %d: %s\n", rank(), message.c_str());
      MPI_Abort(MPI_COMM_WORLD, code);
    }
  }
}

}  // namespace

void begin_agreements() {
  int parallel = 0, ranks = 1;
  MPI_Initialized(&parallel);
  if (!parallel) return;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1) return;
  MPI_Comm_dup(MPI_COMM_WORLD, &everyone());
  stop_rules().alone = false;
}

int largest(int mine, const std::string& error) {
  if (everyone() == MPI_COMM_NULL) return mine;
  int of_all = 0;
  MPI_Request request;
  MPI_Iallreduce(&mine, &of_all, 1, MPI_INT, MPI_MAX, everyone(), &request);
  if (error.empty())
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  else
    wait(request, 3, error);
  return of_all;
}

std::string error_of_any(const std::string& mine) {
  if (everyone() == MPI_COMM_NULL) return mine;
  const int who = largest(mine.empty() ? 0 : rank() + 1, mine) - 1;
  if (who < 0) return {};
  std::string error = mine;
  auto size = static_cast<unsigned>(error.size());
  MPI_Bcast(&size, 1, MPI_UNSIGNED, who, everyone());
  error.resize(size);
  MPI_Bcast(error.data(), static_cast<int>(size), MPI_CHAR, who, everyone());
  return error;
}

std::string failure_of_any(const std::function<void()>& act) {
  std::string error;
  try {
    act();
  } catch (const UserError&) {
    throw;
  } catch (const std::bad_alloc&) {
    error = "there is not enough memory";
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return error_of_any(error);
}

void together(bool acts, const std::function<void()>& act) {
  std::string error;
  bool mistake = false;
  try {
    if (acts) act();
  } catch (const std::exception& exception) {
    error = exception.what();
    mistake = dynamic_cast<const UserError*>(&exception) != nullptr;
  }
  error = error_of_any(error);
  if (error.empty()) return;
  if (largest(mistake) > 0) throw UserError(error);
  throw RunFailure(error);
}

std::pair<int, std::string> worst_of_all(int mine, const std::string& reason) {
  const int worst = largest(mine, reason);
  return {worst, worst > 0 ? error_of_any(reason) : std::string()};
}

bool finite(const Eigen::Ref<const Eigen::VectorXd>& numbers) { return of_first(numbers.allFinite()); }

bool any_stop_requested(bool requested) { return largest(requested) > 0; }

std::vector<double> decided(const std::function<std::vector<double>()>& choose) {
  std::vector<double> numbers;
  std::string error;
  try {
    if (everyone() == MPI_COMM_NULL || rank() == 0) numbers = choose();
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (error = error_of_any(error); !error.empty()) throw RunFailure(error);
  numbers.resize(static_cast<std::size_t>(of_first(static_cast<double>(numbers.size()))));
  take_first(numbers);
  return numbers;
}

void take_first(std::span<double> numbers) {
  if (everyone() != MPI_COMM_NULL) MPI_Bcast(numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, 0, everyone());
}

double of_first(double mine) {
  take_first({&mine, 1});
  return mine;
}

bool of_first(bool mine) { return of_first(mine ? 1. : 0.) != 0; }

void leave_together(int code, const std::string& message) {
  if (everyone() == MPI_COMM_NULL) return;
  MPI_Request all;
  MPI_Ibarrier(everyone(), &all);
  wait(all, code == 2 || code == 3 ? code : 0, rank() > 0 ? message : std::string());
}

}  // namespace tanktread::coupling
