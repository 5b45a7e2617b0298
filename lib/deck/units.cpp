#include "deck/units.hpp"

#include <charconv>
#include <stdexcept>
#include <vector>

#include <udunits2.h>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;

ut_system* in(const std::shared_ptr<void>& system) { return static_cast<ut_system*>(system.get()); }

/// Returns the unit of a text, or null if the text is not a unit.
Unit parsed(const std::shared_ptr<void>& system, std::string text) {
  ut_trim(text.data(), UT_UTF8);
  return {ut_parse(in(system), text.c_str(), UT_UTF8), ut_free};
}

/// Returns the unit `a` divided by the unit `b`; 0 if they have different dimensions.
double ratio(const Unit& a, const Unit& b) {
  if (!a || !b || !ut_are_convertible(a.get(), b.get())) return 0;
  const std::unique_ptr<cv_converter, decltype(&cv_free)> converter(ut_get_converter(a.get(), b.get()), cv_free);
  return cv_convert_double(converter.get(), 1);
}

/// Returns the text `kind`, for example `force/length`, with each word in `words` replaced by its unit. The words are replaced one after another, so
/// a unit must not contain a later word.
std::string replaced(std::string_view kind, const std::vector<std::pair<std::string_view, std::string>>& words) {
  std::string text(kind);
  for (const auto& [word, by] : words)
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + by.size())) text.replace(at, word.size(), by);
  return text;
}

}  // namespace

void UnitOptions::declare(Section& section) {
  section.key("length", length, Choice{},
              "physical length that the value 1 of a length in the deck stands for: a number and a unit, for example `1 um`");
  section.key("time", time, Choice{},
              "physical time that the value 1 of a time in the deck stands for: a number and a unit, for example `1 ms`");
  section.key("force", force, Choice{},
              "physical force that the value 1 of a force in the deck stands for: a number and a unit, for example `1 pN`. With the "
              "default units 1 um, 1 s and 1 pN, stresses are in Pa, surface moduli in uN/m, viscosities in Pa s");
}

Units::Units(const UnitOptions& options) : options_(options) {
  ut_set_error_message_handler(ut_ignore);
  system_ = {ut_read_xml(nullptr), [](void* system) { ut_free_system(static_cast<ut_system*>(system)); }};
  if (!system_) throw UserError("Units: the library UDUNITS does not find its table of units: install it (package libudunits2-data of Debian).");
  const auto check = [this](const char* key, const std::string& text, const char* si) {
    if (!(ratio(parsed(system_, text), parsed(system_, si)) > 0))
      throw UserError("Units/" + std::string(key) + " must be a number and a unit of " + key + ", for example 1 " + si + ", but is " +
                      in_quotes(shortened(text, 80)) + ".");
  };
  check("length", options.length, "m");
  check("time", options.time, "s");
  check("force", options.force, "N");
}

std::string Units::scaled(std::string_view kind) const {
  return replaced(kind, {{" x ", " "}, {"Flow/gravity", "length/time^2"}, {"viscosity", "stress time"}, {"stress", "force/length^2"},
                         {"pressure", "force/length^2"}, {"time", "(" + options_.time + ")"}, {"length", "(" + options_.length + ")"},
                         {"force", "(" + options_.force + ")"}});  // "time" before "length", because a unit of length may contain "time": centimeter
}

double Units::number(const std::string& text, std::string_view kind) const {
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string rest_of_text(rest, text.data() + text.size());
  if (error == std::errc() && rest_of_text.empty()) return number;
  const Unit unit = parsed(system_, rest_of_text);
  if (error != std::errc() || !unit) throw std::invalid_argument("is not a number with a known unit");
  const Unit own = parsed(system_, scaled(kind));
  const double factor = ratio(unit, own);
  if (factor > 0) return number * factor;
  throw std::invalid_argument(own && kind != "1" ? "has a unit of another dimension" : std::string(plain));
}

std::string Units::in_si(std::string_view kind, double number) const {
  const std::string si = replaced(kind, {{" x ", " "}, {"viscosity", "stress time"}, {"stress", "Pa"}, {"pressure", "Pa"},
                                         {"length", "m"}, {"time", "s"}, {"force", "N"}});
  if (si == kind) return {};
  const double factor = ratio(parsed(system_, scaled(kind)), parsed(system_, si));
  return factor > 0 ? formatted("%.10g ", factor * number) + si : std::string();
}

std::string Units::description() const {
  std::string text = "1 is";
  for (const char* kind : {"length", "time", "force", "force/length", "stress", "viscosity"}) text += (text == "1 is" ? " " : ", ") + in_si(kind);
  return text;
}

}  // namespace tanktread::deck
