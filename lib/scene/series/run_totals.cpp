#include "scene/series/run_totals.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "base/formatted.hpp"

namespace tanktread {

namespace {

constexpr std::string_view phase_prefix = "wall seconds of ";

std::string warning_name(std::size_t k) { return formatted("warning %04zu", k); }

using ContactNumbers = Eigen::Matrix<double, 1, 15>;

ContactNumbers numbers_of(const coupling::Contact& contact) {
  const auto& [a, b] = contact.site;
  ContactNumbers numbers;
  numbers << double(contact.particle[0]), double(contact.particle[1]), double(a.element), a.s, a.t, double(b.element), b.s, b.t,
      contact.beyond.transpose(), contact.normal.transpose(), contact.force;
  return numbers;
}

coupling::Contact contact_of(const ContactNumbers& numbers) {
  const auto site = [&](int k) { return spline::Site{static_cast<int>(numbers[k]), numbers[k + 1], numbers[k + 2]}; };
  const auto number = [&](int k) { return static_cast<std::size_t>(numbers[k]); };
  return {{number(0), number(1)}, {site(2), site(5)}, numbers.segment<3>(8).transpose(), numbers.segment<3>(11).transpose(), numbers[14]};
}

void store(const coupling::Contacts& contacts, output::Checkpoint& checkpoint) {
  if (contacts.impulse == 0) return;
  Eigen::MatrixXd rows(contacts.all.size(), ContactNumbers::ColsAtCompileTime);
  for (std::size_t k = 0; k < contacts.all.size(); ++k) rows.row(static_cast<Eigen::Index>(k)) = numbers_of(contacts.all[k]);
  checkpoint.arrays["contacts"] = rows;
  checkpoint.numbers["contact impulse"] = contacts.impulse;
}

coupling::Contacts stored_contacts(const output::Checkpoint& checkpoint) {
  coupling::Contacts contacts;
  if (!checkpoint.arrays.contains("contacts")) return contacts;
  contacts.impulse = checkpoint.numbers.at("contact impulse");
  for (const auto& row : checkpoint.arrays.at("contacts").rowwise()) contacts.all.push_back(contact_of(row));
  return contacts;
}

}  // namespace

static_assert(sizeof(coupling::Contacts) == sizeof(std::vector<coupling::Contact>) + sizeof(double) && sizeof(PhaseAngle) == 2 * sizeof(double) &&
                  sizeof(Warnings::Memory) == 2 * sizeof(double) + sizeof(std::vector<Warning>),
              "store the new member in a checkpoint, and read it");
static_assert(sizeof(RunTotals) == 2 * sizeof(double) + sizeof(coupling::OperationCounts) + 2 * sizeof(int) + sizeof(stokes::Evaluations) +
                                       sizeof(Warnings::Memory) + sizeof(std::vector<PhaseAngle>) + sizeof(coupling::Contacts) +
                                       sizeof(output::Entries<double>),
              "store the new member in a checkpoint, and read it, or add it to each_count()");

output::Entries<long> counts(const RunTotals& totals) {
  output::Entries<long> all;
  each_count(totals, [&](const char* name, auto, auto, const auto& count) { all.emplace_back(name, static_cast<long>(count)); });
  return all;
}

void store(const RunTotals& totals, output::Checkpoint& checkpoint) {
  each_count(totals, [&](const char* name, auto, auto, const auto& count) { checkpoint.numbers[name] = static_cast<double>(count); });
  store(totals.contacts, checkpoint);
  checkpoint.numbers["steps at the limit of stability"] = totals.warnings.limited;
  checkpoint.numbers["wall seconds"] = totals.wall_seconds;
  checkpoint.numbers["growth of waves"] = totals.warnings.waves;
  Eigen::MatrixXd phase_angle(totals.phase_angle.size(), 2);
  for (std::size_t p = 0; p < totals.phase_angle.size(); ++p)
    phase_angle.row(static_cast<Eigen::Index>(p)) << totals.phase_angle[p].degrees, totals.phase_angle[p].rate;
  checkpoint.arrays["phase and tank-treading frequency"] = phase_angle;
  for (const auto& [phase, seconds] : totals.seconds) checkpoint.numbers[std::string(phase_prefix) + phase] = seconds;
  for (std::size_t k = 0; k < totals.warnings.shown.size(); ++k)
    checkpoint.texts[warning_name(k)] = totals.warnings.shown[k].kind + "\n" + totals.warnings.shown[k].sentence;
}

RunTotals stored_totals(const output::Checkpoint& checkpoint) {
  RunTotals totals;
  each_count(totals, [&]<class Count>(const char* name, auto, auto, Count& count) { count = static_cast<Count>(checkpoint.numbers.at(name)); });
  totals.warnings.limited = static_cast<int>(checkpoint.numbers.at("steps at the limit of stability"));
  totals.wall_seconds = checkpoint.numbers.at("wall seconds");
  totals.warnings.waves = checkpoint.numbers.at("growth of waves");
  totals.contacts = stored_contacts(checkpoint);
  for (const auto& row : checkpoint.arrays.at("phase and tank-treading frequency").rowwise()) totals.phase_angle.push_back({row[0], row[1]});
  for (const auto& [name, seconds] : checkpoint.numbers)
    if (name.starts_with(phase_prefix)) totals.seconds.emplace_back(name.substr(phase_prefix.size()), seconds);
  for (std::size_t k = 0; checkpoint.texts.contains(warning_name(k)); ++k) {
    const std::string& text = checkpoint.texts.at(warning_name(k));
    const std::size_t end = text.find('\n');
    totals.warnings.shown.push_back({text.substr(0, end), text.substr(end + 1)});
  }
  return totals;
}

}  // namespace tanktread
