#pragma once
// The program, for main functions that add parts of their own.

#include "scene/registry.hpp"

namespace tanktread {

/// The whole program: reads the command line and the decks, runs the scene that they describe, and returns the exit code. The first statement of
/// main: it starts MPI. Decks may use the parts in `registry`, which `--schema` and `--reference` contain.
int main(int argc, char** argv, const Registry& registry = {});

}  // namespace tanktread
