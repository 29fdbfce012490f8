// What the walkthrough uses of three.js and three-mesh-bvh; bundle.sh makes library.js of it.
export {
  BufferAttribute, BufferGeometry, Box3, DataTexture, DoubleSide, Euler, FloatType, FrontSide, GLSL3, Line3,
  LinearFilter, LineSegments, Mesh, PerspectiveCamera, Quaternion, Ray, Scene, ShaderMaterial, Vector3,
  WebGLRenderTarget, WebGLRenderer, Matrix4,
} from 'three';
export {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
export {PointerLockControls} from 'three/examples/jsm/controls/PointerLockControls.js';
export {MeshBVH} from 'three-mesh-bvh';
