// Steps of mesh_for_radiosity(), in order: choose sizes and joins (join_plan.cpp), cut surfaces
// (cut.cpp), make sample points and patches (points.cpp). Not for use elsewhere.
#pragma once

#include "radiosity/cluster.h"
#include "radiosity/meshing.h"

namespace troffer {

// Base triangles that are joined into sheets and elements (no_cluster: cut instead), with sizes for
// which the bounds hold.
struct JoinPlan {
  float element_size = 0, patch_size = 0, join_angle_deg = 0;
  float coarsened = 1;  // element_size over the requested size
  void set_sizes(double element, double patch, double angle_deg, double coarser) {
    element_size = float(element);
    patch_size = float(patch);
    join_angle_deg = float(angle_deg);
    coarsened = float(coarser);
  }
  Clusters sheets, elements;
};
JoinPlan plan_joining(const BaseGeometry& geometry, const std::vector<uint32_t>& same_as,
                      const MeshingOptions& options);

// Sheet of each element. The sheets' pieces go into the mesh, merged into one polygon if that is
// convex.
struct Cut {
  std::vector<uint32_t> element_sheet;
};
Cut cut_surfaces(const Scene& scene, const JoinPlan& plan, RadiosityMesh& mesh);

// Makes sample points and patches for all sides that light can reach.
void make_points(const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                 const MeshingOptions& options, int threads, const Cut& cut, RadiosityMesh& mesh);

// Hemispherical albedo of the diffuse part and of all other lobes.
struct Reflectances {
  Rgb diffuse, other;
};
Reflectances reflectances(const BsdfTables& tables, const Scene& scene, uint32_t material,
                          const TexturePlace& uv, bool is_front);

}  // namespace troffer
