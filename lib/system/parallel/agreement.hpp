#pragma once
// Agreement of all ranks on an outcome or a decision, even if their local data differ, and detection of ranks that have failed.

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/types.hpp"

namespace tanktread::coupling {

/// Duplicates the MPI communicator, so that the calls below do not interfere with calls on other communicators. Collective; called by Session.
void begin_agreements();

/// Returns the largest `mine` of all ranks. If this rank has an `error` that other ranks do not share, the other ranks may be waiting in a call that
/// this rank will never reach. If they have not arrived here after half a minute, this rank prints the error and ends all ranks with exit code 3.
/// Collective.
int largest(int mine, const std::string& error = {});

/// Returns the error of one of the ranks on all ranks; empty if no rank has an error. Collective; see `largest`.
std::string error_of_any(const std::string& mine);

/// Calls `act` on every rank. Returns the message of the exception if `act` failed on any rank, otherwise an empty text. UserErrors are not caught.
/// Collective.
std::string failure_of_any(const std::function<void()>& act);

/// Calls `act` on the ranks whose `acts` is true. If `act` fails on any of these ranks, every rank throws: UserError for a mistake of the user,
/// otherwise RunFailure. Collective.
void together(bool acts, const std::function<void()>& act);

/// Returns the largest `mine` of all ranks. If this value is not 0, also returns one of the reasons that ranks gave. Collective; see `largest`.
std::pair<int, std::string> worst_of_all(int mine, const std::string& reason);

/// Returns whether numbers that all ranks hold are finite, as determined by the first rank. Collective.
bool finite(const Eigen::Ref<const Eigen::VectorXd>& numbers);

/// Returns whether any rank has received a stop signal, so that all ranks stop together. Collective.
bool any_stop_requested(bool requested);

/// Returns the values that `choose` returns on the first rank. `choose` is not called on other ranks, so that the decision is unique even if the data
/// of the ranks differ by round-off. If `choose` throws, every rank throws RunFailure. Collective.
std::vector<double> decided(const std::function<std::vector<double>()>& choose);

/// Replaces the values on every rank by the values of the first rank, so that all ranks make the same decisions even if their data are not bitwise
/// equal. Collective.
void take_first(std::span<double> numbers);
double of_first(double mine);
bool of_first(bool mine);

/// Lets all ranks end the program together: returns when every rank has arrived. If `code` is 2 or 3 (an error) and other ranks, which do not share
/// the error, have not arrived after half a minute, this rank prints `message` and ends all ranks with `code`. The first rank does not print, because
/// it has already printed the message. Collective; must be the last call of main before the Session ends.
void leave_together(int code, const std::string& message);

}  // namespace tanktread::coupling
