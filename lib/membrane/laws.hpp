#pragma once
// Materials of membranes. A constitutive law is the stored energy per unstressed area, Psi, as a function of the two surface invariants
//
//   I1 = G^ab g_ab - 2 = l1^2 + l2^2 - 2,   I2 = J_s^2 - 1 = l1^2 l2^2 - 1        (3.1)
//
// with the principal stretches l1 and l2. Equation 5 of Maestre et al. 2017 omits the -2 in I1. Psi and its derivatives have the unit force per
// length (energy per area).

#include <array>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "base/register.hpp"
#include "membrane/strain_energy.hpp"

namespace tanktread::membrane {

/// Energy Psi and its first and second derivatives with respect to the invariants I1 and I2. `Number` is double, a register (base/register.hpp) or a
/// dual number.
template <class Number>
struct Response {
  Number psi1, psi2;           ///< dPsi/dI1, dPsi/dI2
  Number psi11, psi12, psi22;  ///< second derivatives
};

/// Neo-Hookean law, Psi = G_s/2 (I1 - 1 + 1/(I2 + 1)), with the shear modulus G_s; strain softening (3.3).
struct NeoHookean {
  double shear_modulus = 1;

  template <class Number>
  Number energy(const Number& i1, const Number& i2) const {
    return (0.5 * shear_modulus) * (i1 - 1.0 + 1.0 / (i2 + 1.0));
  }
  template <class Number>
  Response<Number> response(const Number&, const Number& i2) const {
    const Number inverse = 1.0 / (i2 + 1.0);
    const Number zero = 0.0 * i2;
    return {zero + 0.5 * shear_modulus, (-0.5 * shear_modulus) * inverse * inverse, zero, zero,
            shear_modulus * inverse * inverse * inverse};
  }
  double modulus() const { return shear_modulus; }
  double area_modulus() const { return 3 * shear_modulus; }
  friend bool operator==(const NeoHookean&, const NeoHookean&) = default;
};

/// Skalak's law of a strain-hardening membrane, Psi = G_s/4 (I1^2 + 2 I1 - 2 I2 + C I2^2), with the shear modulus G_s (3.3). C sets the resistance to
/// area changes.
struct Skalak {
  double shear_modulus = 1;
  double area_dilatation = 1;  ///< C, dimensionless resistance to area changes

  template <class Number>
  Number energy(const Number& i1, const Number& i2) const {
    return (0.25 * shear_modulus) * (i1 * i1 + 2.0 * i1 - 2.0 * i2 + area_dilatation * i2 * i2);
  }
  template <class Number>
  Response<Number> response(const Number& i1, const Number& i2) const {
    const Number zero = 0.0 * i2;
    return {(0.5 * shear_modulus) * (i1 + 1.0), (0.5 * shear_modulus) * (area_dilatation * i2 - 1.0), zero + 0.5 * shear_modulus, zero,
            zero + 0.5 * shear_modulus * area_dilatation};
  }
  double modulus() const { return shear_modulus; }
  double area_modulus() const { return (1 + 2 * area_dilatation) * shear_modulus; }
  friend bool operator==(const Skalak&, const Skalak&) = default;
};

/// Law of a thin sheet of incompressible Mooney-Rivlin rubber, Psi = G_s/2 (m (I1 - 1 + 1/(I2 + 1)) + (1 - m) ((I1 + 2)/(I2 + 1) + I2 - 2)), with the
/// shear modulus G_s. m = 1 is the neo-Hookean law. Barthes-Biesel, Diaz & Dhenin, J. Fluid Mech. 460, 2002.
struct MooneyRivlin {
  double shear_modulus = 1;
  double share = 1;  ///< fraction m of the neo-Hookean term

  template <class Number>
  Number energy(const Number& i1, const Number& i2) const {
    return (0.5 * shear_modulus) * (share * (i1 - 1.0 + 1.0 / (i2 + 1.0)) + (1 - share) * ((i1 + 2.0) / (i2 + 1.0) + i2 - 2.0));
  }
  template <class Number>
  Response<Number> response(const Number& i1, const Number& i2) const {
    const double first = 0.5 * shear_modulus * share, second = 0.5 * shear_modulus * (1 - share);
    const Number inverse = 1.0 / (i2 + 1.0), square = inverse * inverse, trace = i1 + 2.0;
    return {second * inverse + first, (-1.0) * (second * trace + first) * square + second, 0.0 * i2, -second * square,
            ((2.0 * second) * trace + 2.0 * first) * square * inverse};
  }
  double modulus() const { return shear_modulus; }
  double area_modulus() const { return 3 * shear_modulus; }
  friend bool operator==(const MooneyRivlin&, const MooneyRivlin&) = default;
};

/// Law of Evans & Skalak, Psi = G_s/2 ((I1 + 2)/J_s - 2) + K_s/2 (J_s - 1)^2. Shear at constant area, with the modulus G_s, and dilatation, with the
/// modulus K_s, are independent. Evans & Skalak, *Mechanics and Thermodynamics of Biomembranes*, 1980.
struct EvansSkalak {
  double shear_modulus = 1;
  double area_dilatation = 1;  ///< area dilatation C: the area modulus is K_s = (1 + 2 C) G_s, as in Skalak's law at small strains

  template <class Number>
  Number energy(const Number& i1, const Number& i2) const {
    const Number js = sqrt(i2 + 1.0);
    return (0.5 * shear_modulus) * ((i1 + 2.0) / js - 2.0) + (0.5 * area_modulus()) * (js - 1.0) * (js - 1.0);
  }
  template <class Number>
  Response<Number> response(const Number& i1, const Number& i2) const {
    const Number square = 1.0 / (i2 + 1.0), inverse = sqrt(square), cube = square * inverse, trace = i1 + 2.0;
    const double g = shear_modulus, k = area_modulus();
    return {(0.5 * g) * inverse, (-0.25 * g) * trace * cube + (-0.5 * k) * (inverse - 1.0), 0.0 * i2, (-0.25 * g) * cube,
            (0.375 * g) * trace * cube * square + (0.25 * k) * cube};
  }
  double modulus() const { return shear_modulus; }
  double area_modulus() const { return (1 + 2 * area_dilatation) * shear_modulus; }
  friend bool operator==(const EvansSkalak&, const EvansSkalak&) = default;
};

/// Area part of Skalak's law, Psi = K/8 I2^2, or of Evans & Skalak's law, Psi = K/2 (J_s - 1)^2, with the area modulus K. It is not a complete law,
/// because it does not resist shear.
struct AreaElasticity {
  double area = 1;      ///< K, force per length
  bool squared = true;  ///< true: Skalak's form, false: Evans & Skalak's form

  template <class Number>
  Number energy(const Number&, const Number& i2) const {
    if (squared) return (0.125 * area) * i2 * i2;
    const Number more = sqrt(i2 + 1.0) - 1.0;
    return (0.5 * area) * more * more;
  }
  template <class Number>
  Response<Number> response(const Number&, const Number& i2) const {
    const Number zero = 0.0 * i2;
    if (squared) return {zero, (0.25 * area) * i2, zero, zero, zero + 0.25 * area};
    const Number square = 1.0 / (i2 + 1.0), inverse = sqrt(square);
    return {zero, (-0.5 * area) * (inverse - 1.0), zero, zero, (0.25 * area) * square * inverse};
  }
  double modulus() const { return area; }
  double area_modulus() const { return area; }
  friend bool operator==(const AreaElasticity&, const AreaElasticity&) = default;
};

/// User-defined law: Psi is the shear modulus G_s times a strain energy given by the user.
struct UserLaw {
  double unit = 1;  ///< shear modulus G_s of the deck, by which the given energy and its moduli are multiplied
  std::shared_ptr<const StrainEnergy> strain_energy;

  template <class Number>
  Number energy(const Number& i1, const Number& i2) const {
    return unit * strain_energy->at(i1, i2).value;
  }
  template <class Number>
  Response<Number> response(const Number& i1, const Number& i2) const {
    const Taylor<Number> psi = unit * strain_energy->at(i1, i2);
    return {psi.by1, psi.by2, psi.by11, psi.by12, psi.by22};
  }
  double modulus() const { return unit; }
  double area_modulus() const { return unit * strain_energy->area_modulus(); }
  friend bool operator==(const UserLaw&, const UserLaw&) = default;
};

/// Energy density of the springs of a MaxwellElement, Psi = G/2 (I1 + 2 - 2 J_s) + K/2 J_s (J_s - 1)^2, with separate terms for shear and dilatation.
/// Psi is an energy per stress-free area, and Psi/J_s is the integrand of (3.23), an energy per current area.
struct MaxwellSpring {
  double shear_modulus = 1;     ///< G, force per length
  double dilatation_modulus = 0;  ///< K, force per length

  template <class Number>
  Number energy(const Number& i1, const Number& i2) const {
    const Number j = sqrt(i2 + 1.0);
    return (0.5 * shear_modulus) * (i1 + 2.0 - 2.0 * j) + (0.5 * dilatation_modulus) * (j * (j - 1.0) * (j - 1.0));
  }
  template <class Number>
  Response<Number> response(const Number&, const Number& i2) const {
    const Number zero = 0.0 * i2, square = i2 + 1.0, j = sqrt(square), inverse = 1.0 / j;
    const double g = shear_modulus, k = dilatation_modulus;
    return {zero + 0.5 * g, (-0.5 * g) * inverse + (0.25 * k) * (3.0 * j - 4.0 + inverse), zero, zero,
            (0.25 * g + 0.125 * k * (3.0 * square - 1.0)) * (inverse * inverse * inverse)};
  }
  double modulus() const { return shear_modulus; }
  double area_modulus() const { return dilatation_modulus; }
  friend bool operator==(const MaxwellSpring&, const MaxwellSpring&) = default;
};

/// Law of an interface with the surface tension sigma, Psi = sigma sqrt(1 + I2) = sigma J_s. The energy is therefore sigma times the current area,
/// and the tension is tau^ab = sigma g^ab. (3.4)
struct SurfaceTension {
  double tension = 1;  ///< sigma, force per length

  template <class Number>
  Number energy(const Number&, const Number& i2) const {
    return tension * sqrt(1.0 + i2);
  }
  template <class Number>
  Response<Number> response(const Number&, const Number& i2) const {
    const Number zero = 0.0 * i2;
    const Number inverse = 1.0 / (1.0 + i2);
    const Number first = (0.5 * tension) * sqrt(inverse);
    return {zero, first, zero, zero, -0.5 * first * inverse};
  }
  double modulus() const { return tension; }
  double area_modulus() const { return 0; }
  friend bool operator==(const SurfaceTension&, const SurfaceTension&) = default;
};

/// Metric of a surface: the scalar products x_,s . x_,s, x_,s . x_,t and x_,t . x_,t of the derivatives of the position x.
template <class Number>
struct SurfaceMetric {
  Number s, st, t;
};

/// Returns the squares of the principal stretches from the unstressed surface (metric `before`) to the current surface (metric `now`), the larger
/// first. They are the eigenvalues of the stretch tensor h in the orthonormal frame whose first axis is along X_,s, the tangent of the unstressed
/// surface. If the two stretches are equal, this formula gives values that are equal to round-off.
template <class Number>
std::array<Number, 2> squared_stretches(const SurfaceMetric<Number>& before, const SurfaceMetric<Number>& now) {
  const Number det = before.s * before.t - before.st * before.st, turn = before.st / before.s;
  const Number h11 = now.s / before.s, h12 = (now.st - turn * now.s) / sqrt(det);
  const Number h22 = (now.t - 2.0 * turn * now.st + turn * turn * now.s) * before.s / det;
  const Number apart = 0.5 * (h11 - h22), larger = 0.5 * (h11 + h22) + sqrt(apart * apart + h12 * h12);
  return {larger, (h11 * h22 - h12 * h12) / larger};
}

/// The law that the deck selects, as a variant. It is visited once per batch of elements, outside the innermost loops.
using Law = std::variant<NeoHookean, Skalak, MooneyRivlin, EvansSkalak, UserLaw, SurfaceTension, AreaElasticity, MaxwellSpring>;

/// A law as the sum of a shear energy and an area elasticity, so that the two can be integrated with different Gauss rules (3.13).
struct SplitLaw {
  Law shear;
  AreaElasticity area;
};

/// Returns Skalak's or Evans & Skalak's law as the sum of a shear law and an area elasticity; empty for all other laws.
std::optional<SplitLaw> split(const Law& law);

/// Returns the modulus, force per length, by which reported tensions are divided: the shear modulus G_s, or the tension sigma of an interface.
double modulus(const Law& law);

/// Returns the area modulus K_s = dT/d(ln A) of an unstressed membrane (T: tension, A: area), 0 for an interface. Force per length.
double area_modulus(const Law& law);

/// Returns the principal tensions (force per current length) at the principal stretches l1 and l2, with the derivatives Psi_k = dPsi/dI_k:
///
///   T_i = (2/J_s) Psi_1 l_i^2 + 2 J_s Psi_2,   J_s = l1 l2                            from (3.2)
std::array<double, 2> principal_tensions(const Law& law, double stretch1, double stretch2);

/// Helfrich's bending energy: the surface integral of E_b/2 (2 chi - c0)^2, with the mean curvature chi = 1/2 div n and the normal n. Its weak form
/// needs a surface that is geometrically C1 across every element side. The Gaussian curvature term is constant on a closed surface and is left out.
struct Bending {
  double modulus = 0;               ///< bending modulus E_b, force x length; 0: no bending
  /// if true, the spontaneous curvature c0 is twice the mean curvature chi of the unstressed surface at each material point
  bool curved_when_relaxed = true;
  double spontaneous_curvature = 0;  ///< spontaneous curvature c0, 1/length; not used if curved_when_relaxed is true

  friend bool operator==(const Bending&, const Bending&) = default;
};

/// Surface viscosity of a Kelvin-Voigt membrane. The following viscous stress is added to the elastic stress; d is the rate of strain of the surface:
///
///   tau^ab = 2 eta_s (d^ab - g^ab d^c_c/2) + kappa_s g^ab d^c_c,   d_ab = (v,a.g_b + g_a.v,b)/2                            (3.10)
///
/// It is the Boussinesq-Scriven law; Barthes-Biesel & Sgaier, J. Fluid Mech. 160, 1985.
struct SurfaceViscosity {
  double shear = 0;        ///< eta_s, viscosity x length
  double dilatational = 0;  ///< kappa_s, viscosity x length

  bool any() const { return shear > 0 || dilatational > 0; }
  friend bool operator==(const SurfaceViscosity&, const SurfaceViscosity&) = default;
};

struct Material {
  Law law;
  Bending bending;
  SurfaceViscosity viscosity{};
  int area_order = 0;  ///< Gauss points per direction for an area elasticity that is integrated separately; 0: integrated with the other terms

  friend bool operator==(const Material&, const Material&) = default;
};

/// The materials of a surface, and the material of each element.
struct Materials {
  std::vector<Material> all;
  std::vector<int> of_element;  ///< material index of each element; empty if there is one material
};

}  // namespace tanktread::membrane
