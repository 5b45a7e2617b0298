#include "deck/value.hpp"

#include <gtest/gtest.h>
#include <Teuchos_ParameterList.hpp>

#include "options.hpp"

namespace tanktread::deck {
namespace {

std::string refusal_of_list(const std::string& lines) {
  Teuchos::ParameterList valid;
  valid.set("Convergence Tolerance", 1e-8)
      .set("Maximum Iterations", 100)
      .set("Orthogonalization", std::string("ICGS"))
      .set("Verbose", false);
  valid.sublist("Inner").set("Depth", 3);
  try {
    check_foreign("Solvers/Belos", *kinds("    Belos:\n" + lines).belos, valid);
  } catch (const UserError& error) {
    return error.what();
  }
  return {};
}

TEST(ForeignLists, WithKnownParametersAreAccepted) {
  EXPECT_EQ(
      refusal_of_list("      Convergence Tolerance: 1e-6\n      Maximum Iterations: 5\n      Verbose: true\n      Inner: {Depth: 4}\n"),
      "");
}

TEST(ForeignLists, WithUnknownParametersAreRejectedWithASuggestion) {
  EXPECT_EQ(
      refusal_of_list("      Maximum Iteration: 5\n"),
      "Solvers/Belos/Maximum Iteration is not a parameter of the library that receives this section; was Solvers/Belos/Maximum Iterations meant?");
  EXPECT_EQ(refusal_of_list("      Inner: {Zebra: 5}\n"),
            "Solvers/Belos/Inner/Zebra is not a parameter of the library that receives this section.");
}

TEST(ForeignLists, WithOtherTypesAreRejected) {
  EXPECT_EQ(refusal_of_list("      Convergence Tolerance: 1\n"),
            "Solvers/Belos/Convergence Tolerance must be a number with a point, but is 1.");
  EXPECT_EQ(refusal_of_list("      Maximum Iterations: 5.5\n"), "Solvers/Belos/Maximum Iterations must be a whole number, but is 5.5.");
  EXPECT_EQ(refusal_of_list("      Inner: 5\n"), "Solvers/Belos/Inner must be a section of keys, but is 5.");
}

}  // namespace
}  // namespace tanktread::deck
