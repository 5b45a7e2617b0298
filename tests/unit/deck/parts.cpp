#include "deck/parts.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "deck/document.hpp"

namespace tanktread::deck {
namespace {

struct PowerOptions {
  double exponent = 2;
  void declare(Section& section) { section.key("exponent", exponent, positive(), "1", "of the power"); }
};

struct NoOptions {
  void declare(Section&) {}
};

using Functions = Parts<double(double)>;

Functions functions() {
  Functions all;
  all.add<PowerOptions>("power", "x to a power", [](const PowerOptions& options, double x) { return std::pow(x, options.exponent); });
  all.add<PowerOptions>(
      "root", "a root of x", [](const PowerOptions& options, double x) { return std::pow(x, 1 / options.exponent); }, {{"root", "1", ""}});
  all.add<NoOptions>("negative", "-x", [](const NoOptions&, double x) { return -x; });
  return all;
}

struct Options {
  Functions registered = functions();
  std::vector<Functions::Chosen> chosen;
  void declare(Section& section) { chosen = registered.read(section, "functions", "functions that are applied"); }
};

std::vector<Functions::Chosen> read(const std::string& yaml) {
  Options options;
  Document document = read_text("Tanktread: {" + yaml + "}");
  document.declare(options);
  return options.chosen;
}

TEST(Parts, AreTheSubsectionsOfTheDeckWithTheirKeys) {
  EXPECT_TRUE(read("").empty());
  const auto both = read("functions: {root: {exponent: 3}, power: {}}");
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].name, "power");
  EXPECT_EQ(both[0].make(5), 25);
  EXPECT_NEAR(both[1].make(8), 2, 1e-15);
  EXPECT_EQ(both[1].columns.size(), 1u);
}

TEST(Parts, WithoutKeysStayInTheEffectiveDeck) {
  Options options, again;
  Document document = read_text("Tanktread: {functions: {negative: {}}}");
  document.declare(options);
  Document effective = read_text(document.effective());
  effective.declare(again);
  ASSERT_EQ(again.chosen.size(), 1u);
  EXPECT_EQ(again.chosen[0].make(5), -5);
}

TEST(Parts, HaveNoOtherKeysAndNoNameTwice) {
  EXPECT_THROW(read("functions: {root: {exponant: 3}}"), UserError);
  EXPECT_THROW(read("functions: {sqrt: {}}"), UserError);
  EXPECT_THROW(read("functions: {root: {exponent: -3}}"), UserError);
  Functions all = functions();
  EXPECT_THROW(all.add<PowerOptions>("root", "", [](const PowerOptions&, double x) { return x; }), std::invalid_argument);
}

TEST(Parts, AreInTheManualUnlessThereAreNone) {
  EXPECT_NE(manual(Options{}).find("of the power"), std::string::npos);
  EXPECT_NE(schema(Options{}).find("\"exponent\""), std::string::npos);
  EXPECT_EQ(manual(Options{.registered = {}, .chosen = {}}).find("functions"), std::string::npos);
}

}  // namespace
}  // namespace tanktread::deck
