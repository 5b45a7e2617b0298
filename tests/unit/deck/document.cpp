#include "deck/document.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_XMLParameterListCoreHelpers.hpp>

#include "options.hpp"

namespace tanktread::deck {
namespace {

namespace fs = std::filesystem;

/// A temporary directory of decks that is deleted at the end of the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("tanktread_deck_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return path / name;
  }
};

Sample sample(const std::vector<std::string>& files, const std::vector<std::string>& settings = {}, const std::string& stored = {}) {
  Sample out;
  Document document = read(files, settings, stored);
  document.declare(out);
  return out;
}

std::string refused(const std::vector<std::string>& files, const std::vector<std::string>& settings = {}) {
  try {
    sample(files, settings);
  } catch (const UserError& error) {
    return error.what();
  }
  return {};
}

TEST(Overlays, ReplaceKeyByKeyAndLeaveTheRest) {
  const Folder folder;
  const auto base = folder.file(
      "base.yaml", "Tanktread:\n  Kinds:\n    count: 4\n    law: hard\n    Inner: {depth: 0.1}\n    Belos: {a: 1, b: {c: 2}}\n");
  const auto over = folder.file("over.yaml", "Tanktread:\n  Kinds:\n    law: soft\n    Inner: {depth: 0.2}\n    Belos: {b: {d: 3}}\n");
  const Sample s = sample({base, over});
  EXPECT_EQ(s.kinds.count, 4);
  EXPECT_EQ(s.kinds.law, "soft");
  EXPECT_EQ(s.kinds.inner.depth, 0.2);
  EXPECT_EQ(s.kinds.belos->get<int>("a"), 1);
  EXPECT_EQ(s.kinds.belos->sublist("b").get<int>("c"), 2);
  EXPECT_EQ(s.kinds.belos->sublist("b").get<int>("d"), 3);
}

TEST(Overlays, MayChangeTheTypeOfAValue) {
  const Folder folder;
  const auto base = folder.file("base.yaml", "Tanktread:\n  Kinds:\n    shear rate: 4\n    center: [1, 2, 3]\n");
  const auto over = folder.file("over.yaml", "Tanktread:\n  Kinds:\n    shear rate: 0.5\n    center: [1., 2., 4.]\n");
  const Sample s = sample({base, over});
  EXPECT_EQ(s.kinds.rate, 0.5);
  EXPECT_EQ(s.kinds.center[2], 4.0);
}

TEST(Settings, OverrideAllDecksAndAreReadAsYaml) {
  const Folder folder;
  const auto base = folder.file("base.yaml", "Tanktread:\n  Kinds:\n    count: 4\n");
  const Sample s =
      sample({base}, {"Kinds/count=5", "Kinds/law=very hard", "Kinds/center=[1, 2., 3]", "Kinds/Inner/depth=1e-1", "Kinds/note=\"x=y\"",
                      "Kinds/enabled=true", "Kinds/Belos/Maximum Iterations=12", "Tanktread/Kinds/shear rate=3"});
  EXPECT_EQ(s.kinds.count, 5);
  EXPECT_EQ(s.kinds.law, "very hard");
  EXPECT_EQ(s.kinds.center, Vec3(1, 2, 3));
  EXPECT_EQ(s.kinds.inner.depth, 0.1);
  EXPECT_EQ(s.kinds.note, "x=y");
  EXPECT_TRUE(s.kinds.enabled);
  EXPECT_EQ(s.kinds.belos->get<int>("Maximum Iterations"), 12);
  EXPECT_EQ(s.kinds.rate, 3.0);
}

TEST(Settings, ThatAreNoSettingsAreRejected) {
  for (const char* setting : {"Kinds/count", "Kinds/count=", "=3", "count=3", "/count=3", "Kinds//count=3"})
    EXPECT_EQ(refused({}, {setting}), std::string("--set '") + setting + "' must be of the form Section/key=value.");
  EXPECT_EQ(refused({}, {"Kinds/count=[1, 2"}), "--set 'Kinds/count=[1, 2': the value is not valid YAML.");
  EXPECT_EQ(refused({}, {"Kinds/cuont=3"}), "Kinds/cuont is not a key of the deck; was Kinds/count meant?");
}

TEST(StoredDecks, AreOverriddenByAllOthers) {
  const Sample s = sample({}, {"Kinds/count=5"}, "Tanktread:\n  Kinds:\n    count: 4\n    law: hard\n");
  EXPECT_EQ(s.kinds.count, 5);
  EXPECT_EQ(s.kinds.law, "hard");
}

TEST(Expectations, BindOnlyForTheKeysTheyWereStatedFor) {
  const Folder folder;
  const auto base = folder.file(
      "base.yaml",
      "Tanktread:\n  Kinds: {count: 4, center: [1, 2, 3]}\n  Expect:\n    a: {value: 1, tolerance: 1}\n    b: {value: 1, tolerance: 1}\n");
  const auto same = folder.file("same.yaml", "Tanktread:\n  Kinds: {count: 4.0, center: [1., 2., 3.]}\n");
  const auto other = folder.file("other.yaml", "Tanktread:\n  Kinds: {count: 5}\n  Expect: {b: {tolerance: 2}}\n");
  const auto excuses = [](const std::vector<Expectation>& all) {
    std::vector<std::string> out;
    for (const Expectation& one : all) out.push_back(one.not_binding);
    return out;
  };
  using Excuses = std::vector<std::string>;
  EXPECT_EQ(excuses(sample({base}).expect.all), (Excuses{"", ""}));
  EXPECT_EQ(excuses(sample({base, same}).expect.all), (Excuses{"", ""}));
  EXPECT_EQ(excuses(sample({base, other}).expect.all), (Excuses{"the deck was changed: Kinds/count", ""})) << "b is stated anew";
  EXPECT_EQ(excuses(sample({base, other}, {"Kinds/law=hard", "Kinds/Inner/depth=1"}).expect.all),
            (Excuses{"the deck was changed: Kinds/Inner/depth, Kinds/count and Kinds/law",
                     "the deck was changed: Kinds/Inner/depth and Kinds/law"}));
  EXPECT_EQ(excuses(sample({base}, {"Kinds/law=hard", "Expect/a/value=2"}).expect.all), (Excuses{"", "the deck was changed: Kinds/law"}));
  EXPECT_EQ(
      excuses(sample({}, {"Expect/a/tolerance=3"}, "Tanktread:\n  Expect: {a: {value: 1, tolerance: 1, not binding: x}}\n").expect.all),
      Excuses{""});
  Sample all;
  Document document = read({base}, {}, {}, "--no-expect");
  document.declare(all);
  EXPECT_EQ(excuses(all.expect.all), (Excuses{"--no-expect", "--no-expect"}));
}

TEST(Xml, IsReadByExtension) {
  const Folder folder;
  const auto file =
      folder.file("deck.xml",
                  "<ParameterList name=\"Tanktread\"><ParameterList name=\"Kinds\">\n"
                  "<Parameter name=\"count\" type=\"int\" value=\"6\"/><Parameter name=\"law\" type=\"string\" value=\"hard\"/>\n"
                  "<Parameter name=\"center\" type=\"Array(double)\" value=\"{1, 2, 3}\"/></ParameterList></ParameterList>\n");
  const Sample s = sample({file});
  EXPECT_EQ(s.kinds.count, 6);
  EXPECT_EQ(s.kinds.law, "hard");
  EXPECT_EQ(s.kinds.center[1], 2.0);
  EXPECT_EQ(refused({folder.file("bad.xml", "<ParameterList")}),
            (folder.path / "bad.xml").string() + " is not XML in the format of parameter lists of Teuchos, a package of Trilinos.");
  std::string deep;
  for (int i = 0; i < 20000; ++i) deep += "<ParameterList name=\"Tanktread\">";
  EXPECT_EQ(refused({folder.file("deep.xml", deep)}),
            (folder.path / "deep.xml").string() + ": its elements are nested more than 100 deep.");
}

TEST(Files, ThatAreNoDecksAreRejectedInOneSentence) {
  const Folder folder;
  const std::string missing = folder.path / "missing.yaml";
  EXPECT_EQ(refused({missing}), "The deck " + missing + " does not exist.");
  EXPECT_EQ(refused({folder.path}), "The deck " + folder.path.string() + " is a directory, not a file.");
  const auto empty = folder.file("empty.yaml", "# nothing\n\n");
  EXPECT_EQ(refused({empty}), empty + " is empty; a deck has one section named `Tanktread`.");
  const auto text = folder.file("text.yaml", "To whom it may concern\n");
  EXPECT_EQ(refused({text}), text + ", line 1: this is not valid YAML (no key followed by a colon): `To whom it may concern`.");
  const auto pipe = (folder.path / "pipe.yaml").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refused({pipe}), "The deck " + pipe + " is not a regular file, but a pipe or a device.");
  EXPECT_EQ(refused({std::string(300, 'x')}), "The deck " + std::string(77, 'x') + "... cannot be read: File name too long.");
  EXPECT_EQ(refused({folder.file("long.yaml", std::string(1'000'001, '#'))}),
            "The deck " + (folder.path / "long.yaml").string() + " is larger than 1 MB.");
  const auto binary = folder.file("binary.yaml", std::string("\x89HDF\r\n\x1a\n\0\0", 10));
  EXPECT_EQ(refused({binary}), binary + ", line 2: this line is not text, but a deck is a text file.");
}

TEST(EffectiveDecks, StateEveryKeyThatIsSet) {
  Sample s;
  Document document =
      read_text("Tanktread:\n  Kinds:\n    law: very hard\n    Belos: {tolerance: 1e-8, solver: \"Block GMRES\", verbose: false}\n");
  document.declare(s);
  EXPECT_EQ(document.effective(),
            "Tanktread:\n  Kinds:\n    shear rate: 1.0\n    count: 3\n    enabled: false\n    law: very hard\n    note: none\n"
            "    center: [0.0, 0.0, 0.0]\n    gradient: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n    Inner:\n      depth: 0.5\n"
            "    Belos:\n      tolerance: 1.0e-08\n      solver: Block GMRES\n      verbose: false\n");
  EXPECT_EQ(document.values().at("Kinds/Inner/depth"), "0.5");
}

TEST(EffectiveDecks, ReadAgainGiveABitwiseEqualScene) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto any_double = [&] { return std::ldexp(static_cast<double>(random()) + 1.0, static_cast<int>(random() % 400) - 260); };
    Sample s, again;
    s.kinds.rate = any_double();
    s.kinds.modulus = any_double();
    s.kinds.center = Vec3(any_double(), -any_double(), 0.1);
    for (double& value : s.kinds.gradient.reshaped()) value = -any_double();
    s.kinds.note = "it's \"quoted\" \\ and: # odd \xc3\xa9 ~23";
    Document first = read_text("Tanktread: {}\n");
    first.declare(s);
    Document second = read_text(first.effective());
    second.declare(again);
    EXPECT_EQ(s.kinds.rate, again.kinds.rate);
    EXPECT_EQ(s.kinds.modulus, again.kinds.modulus);
    EXPECT_EQ(s.kinds.center, again.kinds.center);
    EXPECT_EQ(s.kinds.gradient, again.kinds.gradient);
    EXPECT_EQ(s.kinds.note, again.kinds.note);
    EXPECT_EQ(first.effective(), second.effective());
  }
}

TEST(EffectiveDecks, KeepForeignListsWithTheirTypes) {
  Sample s, again;
  Document first = read_text(
      "Tanktread:\n  Kinds:\n    Belos:\n      real: 3.\n      whole: 3\n      yes it is: true\n      text: \"3\"\n      reals: [1., 2.]\n "
      "     wholes: [1, 2]\n"
      "      texts: [a, \"b c\"]\n      Inner: {real: 1e-10}\n");
  first.declare(s);
  Document second = read_text(first.effective());
  second.declare(again);
  EXPECT_TRUE(Teuchos::haveSameValues(*s.kinds.belos, *again.kinds.belos));
  EXPECT_EQ(again.kinds.belos->get<double>("real"), 3.0);
  EXPECT_EQ(again.kinds.belos->get<std::string>("text"), "3");
}

TEST(ForeignLists, OverrideTheDefaultsOfTheirOwner) {
  Sample s;
  s.kinds.belos = std::make_shared<Teuchos::ParameterList>();
  s.kinds.belos->set("tolerance", 1e-6).set("iterations", 10);
  const auto defaults = s.kinds.belos;
  Document document = read_text("Tanktread:\n  Kinds:\n    Belos: {iterations: 20}\n");
  document.declare(s);
  EXPECT_EQ(s.kinds.belos->get<double>("tolerance"), 1e-6);
  EXPECT_EQ(s.kinds.belos->get<int>("iterations"), 20);
  EXPECT_EQ(defaults->get<int>("iterations"), 10) << "the defaults themselves stay";
}

TEST(Schemas, StateTheTypeOfEveryKey) {
  const std::string text = schema(Sample{});
  const std::string dimensional = R"({"type": ["number", "string"], "pattern": "^[-−+.0-9]")";
  for (const std::string& key :
       {R"("shear rate": )" + dimensional + R"(, "exclusiveMinimum": 0, "description": "rate of the flow [1/time]; default 1.0"})",
        std::string(R"("count": {"type": "integer", "minimum": 1, "maximum": 9, "description": "how many; default 3"})"),
        std::string(R"("limit": {"type": "integer", "minimum": 0, "description")"), std::string(R"("enabled": {"type": "boolean", )"),
        std::string(R"("law": {"enum": ["soft", "hard", "very hard"], )"), std::string(R"("note": {"type": "string", )"),
        R"("axes": {"type": "array", "items": )" + dimensional + R"(, "exclusiveMinimum": 0}, "minItems": 3, "maxItems": 3, )",
        R"("sides": {"type": "array", "items": )" + dimensional + R"(, "exclusiveMinimum": 0}, "minItems": 2, "maxItems": 2, )",
        R"("gradient": {"type": "array", "items": )" + dimensional + R"(}, "minItems": 9, "maxItems": 9, )",
        R"("heights": {"type": "array", "items": )" + dimensional + R"(, "minimum": 0}, "minItems": 1, )"})
    EXPECT_NE(text.find(key), std::string::npos) << key;
}

TEST(Schemas, KeepTheInnerSectionsOfASectionThatMentionsAName) {
  struct Mentioning {
    Inner inner;
    void declare(Section& s) {
      s.mention("other");
      s.section("Inner", inner, "a section");
    }
  };
  const std::string text = schema(Mentioning{});
  EXPECT_NE(text.find(R"("other": true)"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("Inner": {"type": "object", "description": "a section", "properties": {)"), std::string::npos) << text;
}

TEST(Schemas, AllowAllKeysInSectionsThatInheritKeys) {
  struct Alike {
    void declare(Section& s) { s.each("one of several", [](const std::string&, Section&) {}, true); }
  };
  const std::string text = schema(Alike{});
  EXPECT_NE(text.find(R"("properties": {}, "additionalProperties": {"type": "object"}})"), std::string::npos) << text;
}

TEST(Manual, HasOneRowPerKey) {
  const std::string text = manual(Sample{});
  EXPECT_NE(text.find("## Kinds\n\nOne key of each type.\n"), std::string::npos);
  EXPECT_NE(text.find("| `shear rate` | `1.0` | positive | 1/time | rate of the flow |"), std::string::npos);
  EXPECT_NE(text.find("| `modulus` |  | positive | force/length | stiffness |"), std::string::npos);
  EXPECT_NE(text.find("| `law` | `soft` | `soft`, `hard`, `very hard` |  | which \\| law |"), std::string::npos);
  for (const char* row : {"`count` | `3` | whole, between 1 and 9 |", "`enabled` | `false` | true or false |", "`note` | `none` | text |",
                          "`center` | `[0.0, 0.0, 0.0]` | three numbers |", "`sides` |  | two numbers, each positive |",
                          "`stress` |  | nine numbers |", "`heights` |  | one number or more, each not negative |"})
    EXPECT_NE(text.find(row), std::string::npos) << row;
  EXPECT_NE(text.find("## Kinds/Inner"), std::string::npos);
  EXPECT_NE(text.find("## `Expect/<name>`"), std::string::npos);
}

}  // namespace
}  // namespace tanktread::deck
