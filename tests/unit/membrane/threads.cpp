// Membranes give the same bits for any number of threads.

#include <cstring>

#include <gtest/gtest.h>

#include "base/threads.hpp"
#include "tests/unit/membrane/capsules.hpp"

namespace tanktread::membrane {
namespace threads_test {

/// Returns energies, tensions, the load, and products with the tangent and the viscous load, on n threads.
std::vector<double> results(int n) {
  const int before = n_threads();
  set_threads(n);
  const Sphere& one = sphere(4);
  const Material material{.law = Skalak{1, 100}, .bending = {.modulus = 0.1}, .viscosity = {.shear = 0.3}, .area_order = 1};
  const Membrane membrane(one.space, one.net, Materials{{material}, {}});
  const Net x = deformed(one.net), v = random_net(x.rows(), 3);
  std::vector<double> numbers = membrane.element_energies(x, one.elements);
  const auto keep = [&](const auto& some) { numbers.insert(numbers.end(), some.data(), some.data() + some.size()); };
  const ElementTensions tensions = membrane.element_tensions(x, one.elements);
  numbers.insert(numbers.end(), {tensions.smallest, tensions.area_change});
  for (const auto& some : {tensions.area, tensions.compressed, tensions.unstressed, tensions.squared_change}) keep(some);
  keep(membrane.load(x));
  Tangent tangent(membrane);
  ViscousLoad viscous(membrane);
  tangent.update(x, one.elements), viscous.update(x, one.elements);
  Net product;
  tangent.apply(v, product), keep(product);
  viscous.apply(v, product), keep(product);
  set_threads(before);
  return numbers;
}

TEST(ThreadsOfMembranes, HaveTheSameBits) {
  const std::vector<double> one = results(1);
  for (const int n : {2, 3, 5}) {
    const std::vector<double> several = results(n);
    ASSERT_EQ(several.size(), one.size());
    EXPECT_EQ(std::memcmp(several.data(), one.data(), one.size() * sizeof(double)), 0) << n;
  }
}

}  // namespace threads_test
}  // namespace tanktread::membrane
