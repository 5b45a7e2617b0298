#include "deck/words.hpp"

#include <gtest/gtest.h>

namespace tanktread::deck {
namespace {

TEST(Numbers, AreShortAndExact) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-3), "-3");
  EXPECT_EQ(real_text(12), "12.0");
  EXPECT_EQ(real_text(1e-5), "1.0e-05") << "a point and a signed exponent: YAML 1.1 takes anything else for a word";
  EXPECT_EQ(real_text(1e22), "1.0e+22");
  EXPECT_EQ(std::stod(real_text(0.1 + 0.2)), 0.1 + 0.2);
}

TEST(Words, ThatYamlReadsOtherwiseAreNotPlain) {
  for (const char* word : {"soft", "very hard", "neo-Hookean", "x1"}) EXPECT_TRUE(is_plain(word)) << word;
  for (const char* word : {"", "yes", "No", "true", "null", "1", "1e5", "-a", "a: b", "a # b", "a ", "it's", "[a]"})
    EXPECT_FALSE(is_plain(word)) << word;
}

TEST(Guesses, CorrectATypoButNotAnotherWord) {
  const std::vector<std::string> candidates{"type", "shear rate", "viscosity"};
  EXPECT_EQ(guess("typ", candidates), "type");
  EXPECT_EQ(guess("tpye", candidates), "type");
  EXPECT_EQ(guess("shear_rate", candidates), "shear rate");
  EXPECT_EQ(guess("Viscosity", candidates), "viscosity");
  EXPECT_EQ(guess("density", candidates), "");
  EXPECT_EQ(guess("Tube", {"Time"}), "");
}

TEST(Shortened, KeepsWholeCharacters) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefg", 6), "abc...");
  EXPECT_EQ(shortened("ab\xc3\xa9xxxx", 6), "ab...");
}

TEST(Alternatives, ReadAsASentence) {
  EXPECT_EQ(alternatives({"a"}), "a");
  EXPECT_EQ(alternatives({"a", "b"}), "a or b");
  EXPECT_EQ(alternatives({"a", "b", "c"}), "a, b or c");
}

}  // namespace
}  // namespace tanktread::deck
