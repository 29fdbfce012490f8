#version 3.7;
global_settings { assumed_gamma 1.0 ambient_light 1 }
#include "colors.inc"
#default { finish { ambient 0 diffuse 0.7 } }
#declare Paint = texture { pigment { checker White, Gray50 scale 0.5 } finish { specular 0.3 roughness 0.02 } }
#macro Leg(X, Z) cylinder { <X, 0, Z>, <X, 0.7, Z>, 0.03 open } #end
#declare F = function(a, b) { a*b + sqrt(2) }
#declare Places = array[3] { 0.2, 0.5, F(1, 0.5) };
#declare S = seed(3);
difference { box { -0.1, <4.1, 2.6, 3.1> } box { 0, <4, 2.5, 3> } plane { -x, -9 } texture { Paint } }
union { Leg(0.5, 0.5) Leg(1.5, 0.5) box { <0.4, 0.7, 0.4>, <1.6, 0.75, 1.6> } pigment { image_map { png "two-pixels.png" map_type 0 interpolate 2 } } rotate y*10 }
#for (I, 0, 2) sphere { <Places[I], rand(S), 1>, 0.1 pigment { rgbf <0.9, 1, 1, 0.9> } interior { ior 1.5 fade_distance 1 fade_power 2 fade_color Red } } #end
#switch (2) #case (1) box { 0, 1 } #break #range (2, 3) torus { 0.3, 0.05 translate <2, 1, 1> } #break #else cone { 0, 1, y, 0 } #end
mesh2 { vertex_vectors { 3, 0, x, y } uv_vectors { 3, <0, 0>, <1, 0>, <0, 1> } face_indices { 1, <0, 1, 2> } pigment { gradient y color_map { [0 Red] [1 rgbt <0, 0, 1, 0.5>] } } }
mesh { smooth_triangle { 0, y, x, y + x, z, y } triangle { x, y, z } translate 2*x }
prism { linear_sweep linear_spline 0, 0.2, 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0> translate <3, 0, 2> finish { reflection { 0.1, 0.8 falloff 2 } } }
polygon { 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0> matrix <1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 2> finish { emission rgb <3, 3, 2> } }
lathe { linear_spline 3, <0, 0>, <0.2, 0.1>, <0, 0.3> translate 2 }
sor { 5, <0.1, -1>, <0.2, 0>, <0.3, 0.2>, <0.1, 0.4>, <0.1, 1> open translate x }
lathe { bezier_spline 4, <0.1, 0>, <0.2, 0.1>, <0.2, 0.2>, <0.1, 0.3> translate z }
disc { <2, 0.01, 2>, y, 0.5, 0.2 }
#declare N = 0;
#while (N < 2) #if (N = 1) light_source { <2, 2.4, 1.5 - N>, White area_light x, z, 3, 3 fade_distance 1 fade_power 2 } #else light_source { <1, 2, 1>, rgb 0.5 spotlight point_at 0 tightness 3 } #end #declare N = N + 1; #end
sky_sphere { pigment { gradient y color_map { [0 White] [1 Blue] } } }
camera { location <0.5, 1.5, 0.5> look_at <3, 0.5, 2> angle 70 }
