#pragma once

#include <string>

namespace tanktread::coupling {

/// Lets all ranks end the program together: returns once every rank is here. Where an error (`code` above 1) is one that not all ranks share, the
/// others would wait for this one for ever: after half a minute it says `message`, unless it is the first rank, which has said it, and ends all
/// of them with `code`. Collective, and the last call of main before the Session ends.
void leave_together(int code, const std::string& message);

}  // namespace tanktread::coupling
