#pragma once
// The program as a function, for main functions that add user-defined parts.

#include "scene/registry.hpp"

namespace tanktread {

/// Reads the command line and the decks, runs the scene that they describe, and returns the exit code. It starts MPI, so it must be the first
/// statement of main. Decks may use the parts in `registry`, and `--schema` and `--reference` include them.
int main(int argc, char** argv, const Registry& registry = {});

}  // namespace tanktread
