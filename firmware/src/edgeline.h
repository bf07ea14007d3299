/* Edgeline: integer 3D for microcontrollers that drive SPI displays. The one header to include.
 *
 * Conventions. World space is right-handed; the camera looks along -z, y is up; counter-clockwise is the front. Clip
 * space is -w..w, the canonical cube [-1,1]^3. The viewport maps it to [0, width] x [0, height], y down, the origin at
 * the upper left; pixel (i, j) has its centre at (i + 0.5, j + 0.5). Vertices are snapped to 1/16 px (1/64, 1/256:
 * limits.h), to nearest, before culling and set-up. Coverage is the top-left rule, exactly. Depth is 16 bits, 0 near,
 * linear on the screen: the exact plane, rounded to nearest; the test is strictly less, so on equal depth the triangle
 * that was drawn first stays. */
#ifndef EDGELINE_H
#define EDGELINE_H

#include "base/machine.h" /* first */

#include "base/angle.h"
#include "base/bus.h"
#include "base/dither.h"
#include "base/layer.h"
#include "base/port.h"
#include "base/rgb565.h"
#include "base/sink.h"
#include "base/stats.h"
#include "base/status.h"
#include "canvas/canvas.h"
#include "canvas/image.h"
#include "canvas/polygon.h"
#include "canvas/shapes.h"
#include "canvas/stroke.h"
#include "canvas/text.h"
#include "frame/pick.h"
#include "frame/renderer.h"
#include "geometry/aim.h"
#include "geometry/animation.h"
#include "geometry/detail.h"
#include "geometry/elm.h"
#include "geometry/hierarchy.h"
#include "geometry/lights.h"
#include "geometry/mesh.h"
#include "geometry/orbit.h"
#include "geometry/pose.h"
#include "geometry/quaternion.h"
#include "raster/fog.h"
#include "raster/material.h"
#include "scene/instances.h"

#endif
