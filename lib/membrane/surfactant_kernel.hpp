#pragma once
// Sums over the functions of an element and over its Gauss points, on plain arrays. n is the number of Gauss points and k the number of fields. Field
// f at Gauss point q has the index f n + q. The control value of field f for function A has the index A k + f. In tables, function A or its
// derivative at Gauss point q has the index A n + q.

namespace tanktread::membrane {

/// Evaluates k = 1, 3 or 4 fields at the Gauss points from their control values.
void sample(int k, int n, int functions, const double* table, const double* control_values, double* fields);

/// Computes rows[A k + f] = sum_q (N_A,s along_s + N_A,t along_t), summed over the Gauss points q, for each function A and each field f of k = 1 or 3
/// fields.
void test(int k, int n, int functions, const double* by_s, const double* by_t, const double* along_s, const double* along_t, double* rows);

/// Computes the contravariant metric g^11, g^12, g^22 of a surface and the Gauss weights times J, one array after the other. Each tangent is an array
/// of three fields, its components.
void metric(int n, const double* tangents_s, const double* tangents_t, const double* weight, double* metric_and_area);

}  // namespace tanktread::membrane
