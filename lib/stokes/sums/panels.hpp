#pragma once
// The elements as the layer operators see them: panels with Bezier points and far nodes in plain arrays.

#include <deque>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Bernstein polynomials of one degree at the q x q Gauss nodes of the unit square: value[n_nodes b + k], k = q j + i, and derivatives.
struct NodeTable {
  int degree = 3, order = 4, n_bernstein = 16, n_nodes = 16;
  std::vector<double> value, along_s, along_t, weights;
};

/// One Bezier element. Its Bezier points lie at first_bezier + n_bernstein c + b, component c of point b = (p + 1) j + i.
struct Panel {
  const NodeTable* table = nullptr;
  int functions = 0;                 ///< m
  std::size_t first_point = 0;       ///< of its m control-point ids
  std::size_t first_extraction = 0;  ///< of its extraction matrix, (m, n_bernstein) row by row
  std::size_t first_bezier = 0;      ///< of its 3 n_bernstein numbers
  int first_node = 0;                ///< of its far nodes
};

/// All panels of a space; `orders[e]` Gauss points a direction make the far rule of element e.
class Panels {
 public:
  Panels(const spline::Space& space, const std::vector<int>& orders);
  Panels(const Panels&) = delete;
  Panels& operator=(const Panels&) = delete;

  int size() const { return static_cast<int>(panels_.size()); }
  int n_nodes() const { return n_nodes_; }
  std::size_t bezier_size() const { return bezier_size_; }
  const Panel& operator[](int e) const { return panels_[e]; }
  const int* points(int e) const { return &points_[panels_[e].first_point]; }
  const double* extraction(int e) const { return &extraction_[panels_[e].first_extraction]; }

  /// Bezier points of all panels from a control net of any field; or of one of them, in an array for all.
  void bezier(const Net& net, std::vector<double>& points) const;
  void bezier(int e, const Net& net, std::vector<double>& points) const;

 private:
  std::deque<NodeTable> tables_;
  std::vector<Panel> panels_;
  std::vector<int> points_;
  std::vector<double> extraction_;
  int n_nodes_ = 0;
  std::size_t bezier_size_ = 0;
};

/// Which panels are images of others in a symmetric shape: panel e that of source[e] in reflection image[e], or its own source, image[e] = -1.
struct PanelImages {
  std::vector<int> source, image;
  std::vector<surface::Reflection> reflections;

  bool own(int e) const { return image[e] < 0; }
};

/// Values of a field at all far nodes, one array a component, from its Bezier points; or at those of one panel, in arrays for all.
void node_values(const Panels& panels, const std::vector<double>& bezier, std::vector<double> (&value)[3]);
void node_values(const Panels& panels, int e, const std::vector<double>& bezier, std::vector<double> (&value)[3]);

/// Gauss weight times x_,s x x_,t at all far nodes: the outward normal times the area that a node stands for.
void node_normals(const Panels& panels, const std::vector<double>& bezier, std::vector<double> (&normal)[3]);

/// Gauss weight times |x_,s x x_,t| at all far nodes; or at those of one panel, in an array for all.
void node_weights(const Panels& panels, const std::vector<double>& bezier, std::vector<double>& weight);
void node_weights(const Panels& panels, int e, const std::vector<double>& bezier, std::vector<double>& weight);

}  // namespace tanktread::stokes
