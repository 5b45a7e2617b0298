#include "deck/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <udunits2.h>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/quantity.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

/// Units of one dimension that people use for the flow of cells, capsules and drops, the SI unit first, and the range of values in this unit. A value
/// outside is a thousand times smaller or larger than most values in publications: a unit or a prefix is probably wrong.
struct Dimension {
  std::string_view units;  ///< separated by commas
  double least = 0, most = std::numeric_limits<double>::infinity();
};

namespace {

constexpr Dimension dimensions[] = {{"m,um,mm,nm,cm", 5e-9, 1e-2},
                                    {"s,ms,us,min,h", 1e-9, 1e7},
                                    {"1/s,1/min,1/ms,1/h,Hz", 1e-5, 1e7},
                                    {"rad/s,degree/s,rpm", 1e-5, 1e7},
                                    {"degree,deg,rad"},
                                    {"m/s,um/s,mm/s,cm/s,nm/s,mm/min", 1e-12, 10},
                                    {"m/s^2,um/s^2,cm/s^2", 1e-3, 1e8},
                                    {"m^3/s,ul/min,ul/h,ml/h,ml/min,nl/s,nl/min,pl/s,um^3/s,mm^3/s", 1e-21, 1e-5},
                                    {"m^2/s,um^2/s,cm^2/s", 1e-16, 1e-4},
                                    {"Pa s,mPa s,cP,P,g/(cm s),kg/(m s),dyn s/cm^2", 1e-6, 1},
                                    {"Pa,kPa,mPa,MPa,mbar,mmHg,cmH2O,psi,N/m^2,dyn/cm^2,pN/um^2", 1e-6, 1e7},
                                    {"Pa/m,Pa/um,Pa/mm,mbar/mm", 1e-3, 1e10},
                                    {"N,pN,nN,uN,mN,dyn", 1e-16, 1e-2},
                                    {"N/m,uN/m,mN/m,pN/um,nN/um,dyn/cm", 1e-10, 1},
                                    {"N s/m,uN s/m,pN s/um", 1e-12, 1e-3},
                                    {"J,N m,pN um,pN nm,erg,eV", 1e-24, 1e-12},
                                    {"kg/m^3,g/cm^3,g/ml,mg/ml", 1e-3, 1e5},
                                    {"1/m,1/um,1/mm,1/nm", 1, 1e9},
                                    {"1,%"}};

/// Returns the units of a dimension; none if it is null.
std::vector<std::string> usual_units(const Dimension* known) {
  std::vector<std::string> units;
  std::istringstream list(known ? std::string(known->units) : "");
  for (std::string one; std::getline(list, one, ',');) units.push_back(one);
  return units;
}

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;

ut_system* in(const std::shared_ptr<void>& system) { return static_cast<ut_system*>(system.get()); }

/// Returns the unit of a text, or null if the text is not a unit.
Unit parsed(const std::shared_ptr<void>& system, std::string text) {
  ut_trim(text.data(), UT_UTF8);
  return {ut_parse(in(system), text.c_str(), UT_UTF8), ut_free};
}

/// Returns whether the unit is an angle times a power of other units. To UDUNITS, angles are numbers.
bool angular(const Unit& unit) {
  char text[200];
  return ut_format(unit.get(), text, sizeof text, UT_ASCII | UT_DEFINITION) > 0 && std::string_view(text).find("rad") != std::string_view::npos;
}

/// Returns the unit `a` divided by the unit `b`; 0 if they have different dimensions. UDUNITS also converts a unit to its reciprocal, s to 1/s, and
/// units with another zero, neither of which is a ratio.
double ratio(const Unit& a, const Unit& b) {
  if (!a || !b || !ut_are_convertible(a.get(), b.get())) return 0;
  const std::unique_ptr<cv_converter, decltype(&cv_free)> converter(ut_get_converter(a.get(), b.get()), cv_free);
  const double one = cv_convert_double(converter.get(), 1), two = cv_convert_double(converter.get(), 2);
  return std::abs(two - 2 * one) <= 1e-9 * one ? one : 0;
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
  constexpr std::array<const char*, 2> symbols[] = {{"P", "poise"}, {"dyn", "dyne"}, {"deg", "degree"}, {"mins", "minute"}, {"hrs", "hour"}};
  for (const auto& [symbol, name] : symbols)  // of units that UDUNITS knows by their names only
    ut_map_symbol_to_unit(symbol, UT_ASCII, parsed(system_, name).get());
  const auto check = [this](const char* key, std::string& text, const char* si) {
    const Quantity given = quantity(text).value_or(Quantity{1, text});
    if (!(given.number > 0 && is_spelled(given.unit) && ratio(parsed(system_, given.unit), parsed(system_, si)) > 0))
      throw UserError("Units/" + std::string(key) + " must be a number and a unit of " + key + ", for example 1 " + si + ", but is " +
                      in_quotes(shortened(text, 80)) + working_spelling(text) + ".");
    text = real_text(given.number) + " " + given.unit;
  };
  check("length", options_.length, "m");
  check("time", options_.time, "s");
  check("force", options_.force, "N");
}

std::string Units::scaled(std::string_view kind) const {
  return replaced(kind, {{" x ", " "}, {"Flow/gravity", "length/time^2"}, {"viscosity", "stress time"}, {"stress", "force/length^2"},
                         {"pressure", "force/length^2"}, {"time", "(" + options_.time + ")"}, {"length", "(" + options_.length + ")"},
                         {"force", "(" + options_.force + ")"}});  // "time" before "length", because a unit of length may contain "time": centimeter
}

bool Units::is_spelled(const std::string& unit) const {
  if (!is_product_of_words(unit)) return false;
  static const std::regex word("[A-Za-z_%]+");
  for (std::sregex_iterator one(unit.begin(), unit.end(), word); one != std::sregex_iterator(); ++one)
    if (!parsed(system_, one->str())) return false;
  return true;
}

const Dimension* Units::dimension(std::string_view kind) const {
  const Unit own = parsed(system_, scaled(kind));
  const auto* found = std::ranges::find_if(dimensions, [&](const Dimension& one) {
    const Unit si = parsed(system_, usual_units(&one).front());
    return ratio(own, si) > 0 && angular(own) == angular(si);
  });
  return found == std::end(dimensions) ? nullptr : found;
}

std::vector<std::string> Units::alike(const std::string& unit, std::string_view kind) const {
  std::vector<std::string> found;
  for (const std::string& one : usual_units(dimension(kind)))
    if (lower_case(one) == lower_case(unit)) found.push_back(one);
  return found;
}

std::string Units::reason(const Quantity& given, std::string_view kind) const {
  static const std::regex thermal(R"(\b[kK]_?[Bb]?[ *]?T\b)");
  if (std::regex_search(given.unit, thermal))
    return formatted("depends on the temperature: k_B T is 4.1164 pN nm at 25 and 4.2821 pN nm at 37 degrees Celsius; at 25 degrees write %.5g %s",
                     4.1164 * given.number, std::regex_replace(given.unit, thermal, "pN nm").c_str());
  const bool spelled = is_spelled(given.unit);
  std::vector<std::string> units = usual_units(dimension(kind)), meant = alike(given.unit, kind);
  if (const std::string near = guess(given.unit, units); meant.empty() && !spelled && !near.empty()) meant = {near};
  const std::string what = spelled ? "has a unit of another dimension or size" : "is not a number with a known unit";
  if (!meant.empty()) return what + "; was " + number_text(given.number) + " " + alternatives(meant) + " meant?";
  units.resize(std::min<std::size_t>(units.size(), 4));
  return what + (units.empty() ? "" : "; units that work are " + joined(units, " and "));
}

double Units::number(const std::string& text, std::string_view kind) const {
  const std::optional<Quantity> given = quantity(text);
  if (given && given->unit.empty()) return given->number;
  if (const std::string works = working_spelling(text); !given || !works.empty())
    throw std::invalid_argument("is not a number with a known unit" + works);
  const Unit own = parsed(system_, scaled(kind)), unit = is_spelled(given->unit) ? parsed(system_, given->unit) : Unit(nullptr, ut_free);
  const double factor = ratio(unit, own);
  const bool turns = kind == "radian/time" && given->unit.find("Hz") == std::string::npos;  // 1/s may be rad/s, but Hz counts whole turns
  const std::vector<std::string> others = alike(given->unit, kind);
  const bool confused = std::ranges::count(others, given->unit) == 0 &&  // MN/m instead of mN/m
                        std::ranges::any_of(others, [&](const std::string& one) { return std::abs(ratio(unit, parsed(system_, one)) - 1) > 0.5; });
  if (factor > 0 && !confused && (turns || angular(unit) == angular(own))) return given->number * factor;
  throw std::invalid_argument(own && kind != "1" ? reason(*given, kind) : std::string(plain));
}

std::string Units::unusual(std::string_view kind, double number, bool coordinate) const {
  const Dimension* known = dimension(kind);
  if (!known || number == 0) return {};
  const std::string si = usual_units(known).front();
  const double value = std::abs(number) * ratio(parsed(system_, scaled(kind)), parsed(system_, si));
  if ((coordinate || value >= known->least) && value <= known->most) return {};
  return formatted("is %.4g %s, but values of %g to %g %s are usual: check its unit", value, si.c_str(), known->least, known->most, si.c_str());
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
