// The Cornell box of cornell/cornell.toml, in POV-Ray's scene text. Points are those of the measurement, in millimetres;
// z points out of the room here, since POV-Ray's axes are left-handed.
#version 3.7;
global_settings { assumed_gamma 1.0 }

#declare Plain = finish { ambient 0 diffuse 1 }
#declare White = texture { pigment { color rgb <0.7337, 0.7357, 0.7059> } finish { Plain } }
#declare Green = texture { pigment { color rgb <0.1319, 0.3483, 0.1175> } finish { Plain } }
#declare Red = texture { pigment { color rgb <0.5805, 0.0878, 0.0566> } finish { Plain } }
#declare Light = texture { pigment { color rgb <17.0, 11.8, 4.0> } finish { ambient 0 diffuse 0 emission 1 } }

#macro Point(X, Y, Z) <X*0.001, Y*0.001, -Z*0.001> #end
// Four corners, each a vector of millimetres.
#macro Quad(A, B, C, D, Paint)
  polygon {
    5, Point(D.x, D.y, D.z), Point(C.x, C.y, C.z), Point(B.x, B.y, B.z), Point(A.x, A.y, A.z), Point(D.x, D.y, D.z)
    texture { Paint }
  }
#end

#declare floor_ = union { Quad(<552.8, 0, 0>, <0, 0, 0>, <0, 0, 559.2>, <549.6, 0, 559.2>, White) }
object { floor_ }
#declare ceiling = polygon {
  10, Point(0, 548.8, 559.2), Point(556, 548.8, 559.2), Point(556, 548.8, 0), Point(0, 548.8, 0), Point(0, 548.8, 559.2),
  Point(213, 548.8, 227), Point(213, 548.8, 332), Point(343, 548.8, 332), Point(343, 548.8, 227), Point(213, 548.8, 227)
  texture { White }
}
object { ceiling }
#declare lamp = union { Quad(<343, 548.8, 227>, <343, 548.8, 332>, <213, 548.8, 332>, <213, 548.8, 227>, Light) }
object { lamp }

#declare walls = union {
  Quad(<549.6, 0, 559.2>, <0, 0, 559.2>, <0, 548.8, 559.2>, <556, 548.8, 559.2>, White)
  Quad(<0, 0, 559.2>, <0, 0, 0>, <0, 548.8, 0>, <0, 548.8, 559.2>, Green)
  Quad(<552.8, 0, 0>, <549.6, 0, 559.2>, <556, 548.8, 559.2>, <556, 548.8, 0>, Red)
}
object { walls }

// A block on the floor: its corners in the order of the measurement, from the one whose side comes first.
#macro Block(A, B, C, D, H)
  union {
    Quad(A + y*H, B + y*H, C + y*H, D + y*H, White)
    Quad(D, D + y*H, C + y*H, C, White)
    Quad(A, A + y*H, D + y*H, D, White)
    Quad(B, B + y*H, A + y*H, A, White)
    Quad(C, C + y*H, B + y*H, B, White)
  }
#end
#declare short = Block(<130, 0, 65>, <82, 0, 225>, <240, 0, 272>, <290, 0, 114>, 165)
object { short }
#declare tall = union {
  Quad(<423, 330, 247>, <265, 330, 296>, <314, 330, 456>, <472, 330, 406>, White)
  Quad(<423, 0, 247>, <423, 330, 247>, <472, 330, 406>, <472, 0, 406>, White)
  Quad(<472, 0, 406>, <472, 330, 406>, <314, 330, 456>, <314, 0, 456>, White)
  Quad(<314, 0, 456>, <314, 330, 456>, <265, 330, 296>, <265, 0, 296>, White)
  Quad(<265, 0, 296>, <265, 330, 296>, <423, 330, 247>, <423, 0, 247>, White)
}
object { tall }

camera {
  location Point(278, 273, -800)
  right x
  up y
  look_at Point(278, 273, 0)
  angle 39.307652
}
