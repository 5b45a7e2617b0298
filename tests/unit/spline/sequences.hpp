#pragma once
// Random refinement sequences, and the conditions that must hold after each step.

#include <functional>
#include <random>
#include <vector>

#include <Eigen/SparseCore>

#include "spline/extraction.hpp"
#include "spline/refinement.hpp"

namespace tanktread::spline {

/// Returns the mesh after merging elements wherever this is permitted, until it equals `base`, at most eight times.
TMesh merged_wherever_allowed(TMesh mesh, const TMesh& base);

/// The worst values found in one or more sequences.
struct Findings {
  int steps = 0, crossings = 0, overlaps = 0, broken_zones = 0;
  int wrong_counts = 0;       // number of regular elements that do not have 16 functions
  double unity = 0;           // error of the partition of unity
  double residual = 0;        // residual of the transfer of a random field
  double condition = 0;       // condition number of the Greville collocation matrix
  double scaled = 0;          // its condition number with columns of norm 1, which removes the influence of the support of a function
  double least_diagonal = 1;  // smallest diagonal entry of the Greville collocation matrix
  int finest = 1 << 30;       // smallest side of an element in lattice units
  int control_points = 0;
};

/// Expects the conditions that must hold for every refinement sequence: no crossing or overlapping extensions, 16 functions on every regular element,
/// a partition of unity, and an exact transfer of fields to the refined space.
void expect_nested(const Findings& found);

/// Returns the condition number of a square matrix in the 2-norm, by power iteration on C^T C and its inverse.
double condition_number(const Eigen::SparseMatrix<double>& C);

/// Returns the condition number of a dense matrix in the 2-norm, by the eigenvalues of C^T C.
double condition_number(const Eigen::MatrixXd& C);

/// Returns the condition number of the Greville collocation matrix.
double collocation_condition(const Space& s, double* least_diagonal = nullptr, double* scaled = nullptr);

/// Returns marks of `scattered` random elements and of `deep` random elements among the smallest. They are cut both ways (1/2), across s (1/4) or
/// across t (1/4).
std::vector<Mark> random_marks(const TMesh& mesh, int scattered, int deep, std::mt19937& generator);

/// Function that returns the space of a mesh: Catmull-Clark on the cube, or with a pole rule on polar meshes.
using SpaceOf = std::function<Space(const TMesh&)>;
inline Space catmull_clark_space(const TMesh& mesh) { return space(mesh, ExtraordinaryRule::catmull_clark); }

/// Returns the number of regular elements that do not have sixteen functions. An element is regular if it is not a piece at an extraordinary point
/// and has no function of a pole.
int wrong_counts(const TMesh& mesh, const Space& s, int per_pole = 0);

struct SequenceOptions {
  int steps = 4;
  double fraction = 0.02;  // fraction of the elements that are marked at random
  int deep = 1;            // number of marks among the smallest elements
  bool condition = false;  // whether to compute the condition number of the last space
  RepairRules rules;
  SpaceOf space = catmull_clark_space;
  int per_pole = 0;  // number of functions per pole, which are the first and the last control points
};

/// Runs one sequence with a new random field in every step. If one field were transferred through all steps, the test would only show that the first
/// space is contained in all others.
void run_sequence(TMesh mesh, unsigned seed, const SequenceOptions& options, Findings& found);

}  // namespace tanktread::spline
