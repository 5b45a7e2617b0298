#include "system/parallel/ranks.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <utility>

#include <mpi.h>
#include <sched.h>

#include <Kokkos_Core.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>

#include "base/formatted.hpp"
#include "surface/partition.hpp"
#include "system/parallel/agreement.hpp"

namespace tanktread::coupling {

namespace {

/// Returns whether an MPI launcher (of Open MPI, or one that uses PMIx or PMI) started this process. Without a launcher, MPI is not
/// started, because the start of its devices, plugins and threads would take longer than a small run.
bool launched() {
  return std::ranges::any_of(std::array{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}, [](const char* name) { return std::getenv(name); });
}

/// Command-line arguments of Kokkos, separated from the arguments of the program, because Kokkos would otherwise respond to `--help` too.
struct KokkosArguments {
  std::vector<char*> all;
  int count = 0;
  char** begin = nullptr;

  KokkosArguments(int* argc, char*** argv) {
    const auto of_kokkos = [](const char* argument) { return std::string_view(argument).starts_with("--kokkos-"); };
    char **first = *argv, **last = first + *argc;
    all.push_back(*first);
    std::copy_if(first + 1, last, std::back_inserter(all), of_kokkos);
    char** end = std::remove_if(first + 1, last, of_kokkos);
    if (end != last) *end = nullptr;
    *argc = static_cast<int>(end - first);
    count = static_cast<int>(all.size());
    all.push_back(nullptr);
    begin = all.data();
  }
};

}  // namespace

struct Session::Impl {
  Impl(int* argc, char*** argv) {
    KokkosArguments kokkos(argc, argv);
    if (launched()) {
      int provided = 0;
      MPI_Init_thread(&kokkos.count, &kokkos.begin, MPI_THREAD_FUNNELED, &provided);  // only the thread that starts loops calls MPI
      Tpetra::initialize(&kokkos.count, &kokkos.begin);
    } else {
      Kokkos::initialize(kokkos.count, kokkos.begin);
    }
    begin_agreements();
  }
  ~Impl() {
    if (Tpetra::isInitialized()) {
      Tpetra::finalize();
      MPI_Finalize();
    } else {
      Kokkos::finalize();
    }
  }
};

namespace {

Teuchos::RCP<const Teuchos::Comm<int>> communicator() {
  if (Tpetra::isInitialized()) return Tpetra::getDefaultComm();
  return Teuchos::rcp(new Teuchos::SerialComm<int>);
}

}  // namespace

Session::Session(int* argc, char*** argv) : impl_(std::make_unique<Impl>(argc, argv)) {}
Session::~Session() = default;
int Session::rank() const { return communicator()->getRank(); }

namespace {

/// Returns the cores on which this rank may run. If they are not known, the result has more cores than any computer.
cpu_set_t own_cores() {
  cpu_set_t mine;
  if (sched_getaffinity(0, sizeof mine, &mine) != 0) std::memset(&mine, 0xff, sizeof mine);
  return mine;
}

/// Returns the cores on which each rank of this node may run. Collective.
std::vector<cpu_set_t> cores_on_node() {
  const cpu_set_t mine = own_cores();
  if (communicator()->getSize() == 1) return {mine};
  MPI_Comm node = MPI_COMM_NULL;
  int ranks = 0;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, &ranks);
  std::vector<cpu_set_t> all(static_cast<std::size_t>(ranks));
  MPI_Allgather(&mine, sizeof mine, MPI_BYTE, all.data(), sizeof mine, MPI_BYTE, node);
  MPI_Comm_free(&node);
  return all;
}

}  // namespace

int cores_per_rank() {
  const std::vector<cpu_set_t> all = cores_on_node();
  cpu_set_t any;
  CPU_ZERO(&any);
  for (const cpu_set_t& one : all) CPU_OR(&any, &any, &one);
  return std::max(1, CPU_COUNT(&any) / static_cast<int>(all.size()));
}

std::string crowding() {
  if (communicator()->getSize() == 1) return {};
  int length = 0;
  char name[MPI_MAX_PROCESSOR_NAME + 1] = {};
  MPI_Get_processor_name(name, &length);
  const cpu_set_t mine = own_cores();
  const std::vector<cpu_set_t> all = cores_on_node();
  const auto is_within = [&mine](const cpu_set_t& other) {
    cpu_set_t both;
    CPU_AND(&both, &mine, &other);
    return CPU_EQUAL(&both, &other) != 0;
  };
  const int cores = CPU_COUNT(&mine), sharing = static_cast<int>(std::ranges::count_if(all, is_within));
  std::string sentence;
  if (sharing > cores)
    sentence = formatted("%d ranks share %d core%s of %s, so that the run is several times slower: start at most one rank per core "
                         "(on one computer mpirun -n %d), or let the ranks use more cores.",
                         sharing, cores, cores > 1 ? "s" : "", name, cores);
  return error_of_any(sentence);
}

struct Ranks::Impl {
  Teuchos::RCP<const Teuchos::Comm<int>> comm = communicator();
  std::vector<int> rows;
  surface::Symmetry symmetry;
  Phases* phases = nullptr;

  std::unique_ptr<Phases::Scope> time() const { return phases ? std::make_unique<Phases::Scope>(*phases, "exchange") : nullptr; }
};

Ranks::Ranks() : impl_(std::make_unique<Impl>()) {}
Ranks::~Ranks() = default;
int Ranks::rank() const { return impl_->comm->getRank(); }
int Ranks::size() const { return impl_->comm->getSize(); }
void Ranks::measure(Phases& phases) { impl_->phases = &phases; }

void Ranks::set_owned_rows(const std::vector<int>& rows, surface::Symmetry symmetry) {
  impl_->rows = rows;
  impl_->symmetry = std::move(symmetry);
}

std::vector<int> Ranks::divide_points(const spline::Space& space, const surface::Symmetry& symmetry) {
  std::vector<int> rows = surface::share(space, surface::partition_of_points(space, size(), symmetry.fundamental()), rank()).points;
  set_owned_rows(rows, symmetry);
  return rows;
}

std::vector<int> Ranks::divide_in_order(const surface::Symmetry& symmetry) {
  std::vector<int> rows;
  for (const int k : share(static_cast<int>(symmetry.fundamental().size()))) rows.push_back(symmetry.fundamental()[static_cast<std::size_t>(k)]);
  set_owned_rows(rows, symmetry);
  return rows;
}

void Ranks::replicate(Net& net) const {
  if (size() == 1) return impl_->symmetry.complete(net);
  const Net own = net(impl_->rows, Eigen::all);
  net(impl_->symmetry.fundamental(), Eigen::all).setZero();
  net(impl_->rows, Eigen::all) = own;
  Net* const only[] = {&net};
  add(only);
}

void Ranks::add(std::span<Net* const> nets) const {
  if (size() == 1) return;
  const std::vector<int>& all = impl_->symmetry.fundamental();
  assert(!all.empty());  // divide_points() was called
  std::vector<double> numbers;
  numbers.reserve(3 * all.size() * nets.size());
  for (const Net* net : nets)
    for (const int a : all)
      for (int c = 0; c < 3; ++c) numbers.push_back((*net)(a, c));
  add(numbers);
  const double* next = numbers.data();
  for (Net* net : nets) {
    for (const int a : all)
      for (int c = 0; c < 3; ++c) (*net)(a, c) = *next++;
    impl_->symmetry.complete(*net);
  }
}

void Ranks::add(std::span<double> numbers) const {
  if (size() == 1) return;
  const auto clock = impl_->time();
  constexpr std::size_t at_a_time = 1 << 24;  // sends large data in parts, because MPI counts with int and each part is copied
  for (std::size_t first = 0; first < numbers.size(); first += at_a_time) {
    const std::span<double> part = numbers.subspan(first, std::min(at_a_time, numbers.size() - first));
    const std::vector<double> mine(part.begin(), part.end());
    Teuchos::reduceAll(*impl_->comm, Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), part.data());
  }
}

void Ranks::add_all(std::span<const std::span<double>> several) const {
  std::vector<double> numbers;
  for (const auto& some : several) numbers.insert(numbers.end(), some.begin(), some.end());
  add(numbers);
  const double* next = numbers.data();
  for (const auto& some : several) next = std::ranges::copy_n(next, static_cast<std::ptrdiff_t>(some.size()), some.begin()).in;
}

stokes::Evaluations Ranks::of_all(const stokes::Evaluations& own) const {
  static_assert(sizeof(own) == 3 * sizeof(long long), "add the new count here and wherever Evaluations are added, printed or stored");
  std::array sum = {static_cast<double>(own.far), static_cast<double>(own.near), static_cast<double>(own.self)};
  add(sum);
  return {std::llround(sum[0]), std::llround(sum[1]), std::llround(sum[2])};
}

std::vector<int> Ranks::share(int n) const {
  std::vector<int> mine;
  for (int k = 0; k < n; ++k)
    if (owner(k, n) == rank()) mine.push_back(k);
  return mine;
}

}  // namespace tanktread::coupling
