// A still life below a window of light: bodies of revolution, glass, metal, a tiled table, bars made by a loop.
#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "colors.inc"

#declare Wall = texture { pigment { color rgb <0.75, 0.72, 0.66> } finish { diffuse 1 ambient 0 } }

// The room: a large box less a smaller one, and less a window in its left wall.
difference {
  box { <-2.1, -0.1, -2.6>, <2.1, 2.6, 2.1> }
  box { <-2, 0, -2.5>, <2, 2.5, 2> }
  box { <-2.2, 0.9, -1>, <-1.9, 2.1, 1> }
  texture { Wall }
}
#for (I, 0, 4)
  box { <-2.06, 0.9, -0.99 + 0.49*I>, <-2.02, 2.1, -0.97 + 0.49*I> pigment { Gray30 } }
#end
light_source {
  <-4.5, 3.5, 0> color rgb <9, 8.6, 8>
  area_light z*1.5, y*1.5, 5, 5
  fade_distance 2 fade_power 2
}
sky_sphere { pigment { gradient y color_map { [0 rgb <0.9, 0.95, 1>] [1 rgb <0.35, 0.55, 0.9>] } } }

// The table.
box {
  <-1, 0.7, -0.6>, <1, 0.75, 0.6>
  pigment { checker rgb <0.55, 0.32, 0.18>, rgb <0.85, 0.75, 0.6> scale 0.1 }
  finish { specular 0.4 roughness 0.01 }
}
#declare Leg = cylinder { 0, y*0.7, 0.04 pigment { DarkWood } }
#declare X = -0.9;
#while (X < 1)
  object { Leg translate <X, 0, -0.5> }
  object { Leg translate <X, 0, 0.5> }
  #declare X = X + 1.8;
#end

// A vase, a bottle of green glass, a metal ring, an orange, and a small lamp.
#declare Vase = lathe {
  linear_spline 8,
  <0, 0>, <0.08, 0>, <0.12, 0.12>, <0.09, 0.24>, <0.04, 0.32>, <0.06, 0.36>, <0.05, 0.36>, <0, 0.3>
  pigment { color rgb <0.2, 0.3, 0.6> }
  finish { phong 0.8 phong_size 90 }
}
object { Vase translate <-0.35, 0.75, 0.1> }
sphere {
  <0.3, 0.9, -0.2>, 0.15
  pigment { color rgbf <0.9, 1, 0.92, 1> }
  finish { ambient 0 diffuse 0 specular 0.8 }
  interior { ior 1.5 fade_distance 0.3 fade_power 1001 fade_color <0.3, 0.9, 0.5> }
}
torus {
  0.09, 0.02
  pigment { color rgb <0.95, 0.8, 0.45> }
  finish { ambient 0 diffuse 0.05 metallic specular 0.9 roughness 0.003 }
  translate <-0.05, 0.77, -0.35>
}
sphere { <0.03, 0.82, 0.05>, 0.07 pigment { Orange } finish { diffuse 0.8 phong 0.3 phong_size 20 } }
union {
  cylinder { 0, y*0.02, 0.07 pigment { Gray20 } }
  cylinder { y*0.02, y*0.3, 0.01 pigment { Gray20 } }
  sphere { y*0.35, 0.06 pigment { color rgb <1, 0.85, 0.6> } finish { ambient 0 diffuse 0 emission 6 } }
  translate <0.7, 0.75, 0.25>
}

camera { location <0.35, 1.35, -2.2> look_at <0, 0.85, 0> angle 48 right x*4/3 }
