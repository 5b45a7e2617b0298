#pragma once
// Random refinement sequences and what must hold after each step.

#include <functional>
#include <random>
#include <vector>

#include <Eigen/SparseCore>

#include "spline/extraction.hpp"
#include "spline/refinement.hpp"

namespace tanktread::spline {

/// The mesh after merging elements wherever that is allowed, until it is `base` again or eight times.
TMesh merged_wherever_allowed(TMesh mesh, const TMesh& base);

/// The worst of everything seen along one or more sequences.
struct Findings {
  int steps = 0, crossings = 0, overlaps = 0, broken_zones = 0, straddling = 0;
  int wrong_counts = 0;       // regular elements with other than 16 functions
  double unity = 0;           // defect of the partition of unity
  double residual = 0;        // of the transfer of a fresh random field
  double condition = 0;       // of Greville collocation
  double scaled = 0;          // the same with columns of length one: how wide a function is no longer counts
  double least_diagonal = 1;  // and its smallest diagonal entry
  int finest = 1 << 30;       // lattice units
  int control_points = 0;
};

/// What every sequence must have kept.
void expect_nested(const Findings& found);

/// Condition number of a square matrix in the 2-norm, by power iteration on C^T C and its inverse.
double condition_number(const Eigen::SparseMatrix<double>& C);

/// The same of a dense one, by its eigenvalues.
double condition_number(const Eigen::MatrixXd& C);

/// Of the Greville collocation matrix.
double collocation_condition(const Space& s, double* least_diagonal = nullptr, double* scaled = nullptr);

/// Random elements cut both ways (1/2), across s (1/4), across t (1/4); `deep` marks go to the smallest elements.
std::vector<Mark> random_marks(const TMesh& mesh, int scattered, int deep, std::mt19937& generator);

/// The space of a sequence: Catmull-Clark on the cube, a pole rule on polar meshes.
using SpaceOf = std::function<Space(const TMesh&)>;
inline Space catmull_clark_space(const TMesh& mesh) { return space(mesh, ExtraordinaryRule::catmull_clark); }

/// Regular elements with other than sixteen functions: those that are no piece at an extraordinary point and without functions of a pole.
int wrong_counts(const TMesh& mesh, const Space& s, int per_pole = 0);

struct SequenceOptions {
  int steps = 4;
  double fraction = 0.02;  // of the elements, marked anywhere
  int deep = 1;            // marks among the smallest elements
  bool condition = false;  // of the last space
  RepairRules rules;
  SpaceOf space = catmull_clark_space;
  int per_pole = 0;  // functions of a pole, the first and the last control points
};

/// One sequence; a fresh random field in every step. Carrying one field through all steps would only test that the first space is contained
/// in all others.
void run_sequence(TMesh mesh, unsigned seed, const SequenceOptions& options, Findings& found);

}  // namespace tanktread::spline
