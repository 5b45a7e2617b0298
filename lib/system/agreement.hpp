#pragma once
// What all ranks agree on, whatever the data of each one says: an outcome, a decision, and that all of them are still there.

#include <span>
#include <string>

namespace tanktread::coupling {

/// Prepares the calls below, which must not meet those of any other communicator. Collective; part of a Session.
void begin_agreements();

/// The largest `mine` of all ranks. Collective. A rank with an `error` that not all of them share may be waited for in a call that it will not come
/// to: after half a minute it says the error and ends all of them with exit code 3.
int largest(int mine, const std::string& error = {});

/// The error of one of the ranks, on all of them; empty where none has one. Collective; see `largest`.
std::string error_of_any(const std::string& mine);

/// The first rank's numbers, on every rank: of data that should be equal to the bit, so that a decision is one even where it is not. Collective.
void take_first(std::span<double> numbers);
double of_first(double mine);
bool of_first(bool mine);

/// Lets all ranks end the program together: returns once every rank is here. Where an error (`code` is 2 or 3) is one that not all ranks share,
/// after half a minute this one says `message`, unless it is the first rank, which has said it, and ends all of them with `code`. Collective, and
/// the last call of main before the Session ends.
void leave_together(int code, const std::string& message);

}  // namespace tanktread::coupling
