#pragma once
// Which stator faces lie near a rotor face: bins in (theta, z) or (x, y) over each part of the interface.
#include <vector>

#include "mesh/sliding/sliding_surface.hpp"

namespace snag {

class SlidingBins {
 public:
  explicit SlidingBins(const RevolvedSurface& surface);
  /// Stator faces of the same part whose box, a hair wider, the box of the face meets, rising, in `candidates`. `flat`: the face about its
  /// base.
  void near(const RevolvedFace& face, const FlatFace& flat, Point2 base, Angle base_angle, std::vector<int>& candidates);
  /// Positions of the stator's nodes in the axis frame.
  const std::vector<Point2>& plane() const { return plane_; }

 private:
  struct Box {
    Point2 lower, upper;
  };
  /// Bins of one part; where it `wraps`, the first coordinate is an angle and the bins go once around.
  struct Part {
    Point2 lower{}, width{};
    int n_x = 0, n_y = 0;
    bool wraps = false;
    std::vector<int> start, face;  // compressed rows
    std::vector<int> next;         // where each row is filled
    template <class Act>
    void for_each_bin(const Box& box, const Act& act) const;
  };
  static Box box_of(const RevolvedFace& face, const FlatFace& flat, Point2 base, Angle base_angle);
  Part& part_of(const RevolvedFace& face) { return face.is_disc ? discs_[face.part] : cylinders_[face.part]; }
  const Part& part_of(const RevolvedFace& face) const { return face.is_disc ? discs_[face.part] : cylinders_[face.part]; }
  void size_bins(const std::vector<RevolvedFace>& faces, const std::vector<Box>& boxes);

  std::vector<Part> cylinders_, discs_;
  std::vector<Box> box_;          // of each stator face
  std::vector<int> last_search_;  // in which each of them was seen
  int search_ = 0;
  std::vector<Point2> plane_;
  std::vector<double> radii_;  // m
};

}  // namespace snag
