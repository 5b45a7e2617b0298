#include "deck/words.hpp"

#include <gtest/gtest.h>

#include "options.hpp"

namespace tanktread::deck {
namespace {

TEST(Synonyms, AreFoundInAnySpelling) {
  for (const char* name : {"dt", "time_step", "Time-Step"}) EXPECT_EQ(synonym(name), "Time/fixed step or Time/initial step") << name;
  for (const char* name : {"tend", "t_end", "T end", "end time"}) EXPECT_EQ(synonym(name), "Time/final time") << name;
  for (const char* name : {"", "/", "|", "zebra", "shear rate"}) EXPECT_EQ(synonym(name), "") << name;
}

TEST(Synonyms, MayBelongToOneListOnly) {
  EXPECT_EQ(synonym("Membrane/viscosity"), "Membrane/shear viscosity");
  EXPECT_EQ(synonym("viscosity"), "");
}

TEST(MissingFeatures, AreKnownByPathOrName) {
  EXPECT_NE(missing_feature("Flow/Reynolds number"), "");
  EXPECT_EQ(missing_feature("Flow/viscosity"), "");
  EXPECT_NE(missing_feature("Temperature"), "");
  EXPECT_EQ(missing_feature("Surfactant"), "");
}

TEST(UnknownKeys, AreRejectedWithTheMissingFeatureOrASuggestion) {
  EXPECT_EQ(refusal("    Temperature: 1\n"),
            "Kinds/Temperature is not a key of the deck: Brownian motion is not available (README.md lists what the program can do).");
  EXPECT_EQ(refusal("    Surfactant: 1\n"), "Kinds/Surfactant is not a key of the deck; was the section Interface/surfactant meant?");
  EXPECT_EQ(refusal("    tend: 1\n"), "Kinds/tend is not a key of the deck; was Time/final time meant?");
  EXPECT_EQ(refusal_of("Tanktread:\n  Particles:\n    - {a: 1}\n"),
            "deck.yaml, line 3: Particles is a sequence (brackets, or lines with dashes), but a deck has sequences of numbers or words "
            "only: sections with keys have names, such as Particles/<name>.");
}

}  // namespace
}  // namespace tanktread::deck
