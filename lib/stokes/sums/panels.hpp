#pragma once
// The elements in the form used by layer operators: panels with Bezier points and far nodes in plain arrays.

#include <deque>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

constexpr int panel_block = 64;  ///< number of panels that a thread takes at a time in loops over panels that do little work per panel

/// Bernstein polynomials of one degree and their derivatives at the q x q Gauss nodes of the unit square, q = `order`: value[n_nodes b + k] is
/// polynomial b at node k = q j + i, which is node i along s and node j along t.
struct NodeTable {
  int degree = 3, order = 4, n_bernstein = 16, n_nodes = 16;
  std::vector<double> value, along_s, along_t, weights;
};

/// One Bezier element of degree p. Component c of its Bezier point b = (p + 1) j + i is stored at index first_bezier + n_bernstein c + b.
struct Panel {
  const NodeTable* table = nullptr;
  int functions = 0;                 ///< number m of basis functions of the panel
  std::size_t first_point = 0;       ///< position of the first of the panel's m control-point indices in a list for all panels
  std::size_t first_extraction = 0;  ///< index of the first entry of the element's extraction matrix, shape (m, n_bernstein), stored row by row
  std::size_t first_bezier = 0;      ///< index of the first of the panel's 3 n_bernstein Bezier coordinates
  int first_node = 0;                ///< index of the first far node of the panel among the far nodes of all panels
};

/// All panels of a space. The far rule of element e has `orders[e]` Gauss points per direction.
class Panels {
 public:
  Panels(const spline::Space& space, const std::vector<int>& orders);
  Panels(const Panels&) = delete;
  Panels& operator=(const Panels&) = delete;

  int size() const { return static_cast<int>(panels_.size()); }
  int n_nodes() const { return n_nodes_; }
  const Panel& operator[](int e) const { return panels_[e]; }
  const int* points(int e) const { return &points_[panels_[e].first_point]; }
  const double* extraction(int e) const { return &extraction_[panels_[e].first_extraction]; }

  /// Computes the Bezier points of all panels from the control net of any field.
  void bezier(const Net& net, std::vector<double>& points) const;

 private:
  std::deque<NodeTable> tables_;
  std::vector<Panel> panels_;
  std::vector<int> points_;
  std::vector<double> extraction_;
  int n_nodes_ = 0;
  std::size_t bezier_size_ = 0;
};

/// Panels that are symmetry images of other panels. Panel e is the image of panel source[e] under reflection image[e]. If image[e] = -1, panel e is
/// not an image and source[e] = e.
struct PanelImages {
  std::vector<int> source, image;
  std::vector<surface::Reflection> reflections;

  bool is_image(int e) const { return image[e] >= 0; }
};

/// Computes the values of a field at all far nodes from the field's Bezier points, one array per component.
void node_values(const Panels& panels, const std::vector<double>& bezier, std::vector<double> (&value)[3]);

/// Computes Gauss weight times x_,s x x_,t at all far nodes: the outward normal times the area that the node represents.
void node_normals(const Panels& panels, const std::vector<double>& bezier, std::vector<double> (&normal)[3]);

/// Compute Gauss weight times |x_,s x x_,t| at all far nodes, or at the far nodes of panel e only. `weight` is the array for all far nodes.
void node_weights(const Panels& panels, const std::vector<double>& bezier, std::vector<double>& weight);
void node_weights(const Panels& panels, int e, const std::vector<double>& bezier, std::vector<double>& weight);

}  // namespace tanktread::stokes
