#pragma once
// The program as a function, for a main function that adds user-defined parts (loads, fields, flows, media, series, equations).

#include "scene/registry.hpp"

namespace tanktread {

/// Reads the command line and the decks, runs the scene that they describe, and returns the exit code. Call it as the first statement of the C++
/// function main, because it starts MPI. `registry`: user-defined parts that decks may use; `--schema` and `--reference` include their keys.
int main(int argc, char** argv, const Registry& registry = {});

}  // namespace tanktread
