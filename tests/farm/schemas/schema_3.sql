-- As schema 4, before records of results changed.
BEGIN TRANSACTION;
CREATE TABLE counter (name TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
INSERT INTO "counter" VALUES('baked',9);
INSERT INTO "counter" VALUES('hits',3);
INSERT INTO "counter" VALUES('near_hits',0);
INSERT INTO "counter" VALUES('uses',12);
CREATE TABLE job (
  id INTEGER PRIMARY KEY AUTOINCREMENT, request_id TEXT UNIQUE, manifest TEXT NOT NULL, preset TEXT NOT NULL,
  settings TEXT NOT NULL, overrides TEXT NOT NULL, region TEXT NOT NULL, state INTEGER NOT NULL, error TEXT NOT NULL,
  sectors_cached INTEGER NOT NULL, created INTEGER NOT NULL, ended INTEGER NOT NULL, sectors_near INTEGER NOT NULL DEFAULT 0,
  largest_bound REAL NOT NULL DEFAULT 0);
INSERT INTO "job" VALUES(1,'f2ce44e48c2d48847adc3014e84abd00','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4','draft','{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.001953125}','{"bounces":"0","min_distance":"16","rays":"16","reach":"8"}','',1,'',0,1795732530,1795732530,0,0.0);
INSERT INTO "job" VALUES(2,'bbf9a37b04c729927b022ed2b9c4a830','3ec33deac46f37c945005e0b8bd68e1243508ce3000d1ab642ba69667bf5b8b4','draft','{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.0625}','{"bounces":"0","min_distance":"16","rays":"16","reach":"8","tolerance":"0.0625"}','[0.0,0.0,127.0,127.0]',1,'',3,1795732530,1795732530,0,0.0);
INSERT INTO "job" VALUES(3,'93f268ecb784881c59025cc6823bd8ed','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4','draft','{"bounces":8,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":1.0,"rays":65536,"reach":512.0,"tolerance":0.001953125}','{"bounces":"8","min_distance":"1","rays":"65536"}','',1,'',0,1795732530,1795732535,0,0.0);
CREATE TABLE job_task (job INTEGER NOT NULL, task INTEGER NOT NULL, PRIMARY KEY (job, task)) WITHOUT ROWID;
INSERT INTO "job_task" VALUES(1,1);
INSERT INTO "job_task" VALUES(1,2);
INSERT INTO "job_task" VALUES(1,3);
INSERT INTO "job_task" VALUES(1,4);
INSERT INTO "job_task" VALUES(2,5);
INSERT INTO "job_task" VALUES(2,6);
INSERT INTO "job_task" VALUES(2,7);
INSERT INTO "job_task" VALUES(2,8);
INSERT INTO "job_task" VALUES(3,9);
INSERT INTO "job_task" VALUES(3,10);
INSERT INTO "job_task" VALUES(3,11);
INSERT INTO "job_task" VALUES(3,12);
CREATE TABLE map (manifest TEXT PRIMARY KEY, summary TEXT NOT NULL) WITHOUT ROWID;
INSERT INTO "map" VALUES('38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4','{"content":"d0ed72ead5f85ed1ac16d0ebf4f81ee86ef589059e875c2a8c5053e4ec5d351e","id":0,"inventory":"bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63","objects":1,"sectors":[[0,0],[1,0],[0,1],[1,1]],"triangles":2,"warnings":[]}');
INSERT INTO "map" VALUES('3ec33deac46f37c945005e0b8bd68e1243508ce3000d1ab642ba69667bf5b8b4','{"content":"5f5730fc5d7a4fbb27eb21d046933f3028b48d6cb9c3eb6dc212a86f63311381","id":0,"inventory":"152fd8e787c5740626902cb6956980d52840699635828f21c0fea88510e28083","objects":2,"sectors":[[0,0],[1,0],[0,1],[1,1]],"triangles":4,"warnings":[]}');
CREATE TABLE result (
  id INTEGER PRIMARY KEY, i INTEGER NOT NULL, j INTEGER NOT NULL, settings_key TEXT NOT NULL, file TEXT NOT NULL, size INTEGER NOT NULL,
  probes INTEGER NOT NULL, rays INTEGER NOT NULL, warnings TEXT NOT NULL, footprint TEXT NOT NULL, inventory TEXT NOT NULL,
  footprint_size INTEGER NOT NULL, seconds REAL NOT NULL, used INTEGER NOT NULL);
INSERT INTO "result" VALUES(1,0,0,'f48f1ee48dc5a03a3a7056dc2049f7e3f738c9a55fa6d9f7c11831739c2a2f26','43e546bfdc12ba4882135447f6949a084d94a24f8a5c9a9f8bd02a13af3306be',6336,16,384,'','9ef26deccec5edfdde81c6d09448d94e2789da260b8b8826305b5eb023807a33','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',195,0.019059787,5);
INSERT INTO "result" VALUES(2,1,0,'f48f1ee48dc5a03a3a7056dc2049f7e3f738c9a55fa6d9f7c11831739c2a2f26','e55d8e38da493cda6f803b36e24d12f694c453dc15e89ff1807e9b81b8715f81',6336,16,384,'','a717fc1fa782558b496062e9abd271bb0efb7ffb501baf0dffdbb6e344a6f516','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',199,0.018613554,6);
INSERT INTO "result" VALUES(3,1,1,'f48f1ee48dc5a03a3a7056dc2049f7e3f738c9a55fa6d9f7c11831739c2a2f26','6cfac20a79c199a31c7d9c76b493d98588685021b3a37e1d420da47703f6362d',6464,17,408,'','2cca4243fde3a3277e93ff74d4fb4579e4ce42f6332325e7efbb7a964d63de26','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',206,0.020005381,3);
INSERT INTO "result" VALUES(4,0,1,'f48f1ee48dc5a03a3a7056dc2049f7e3f738c9a55fa6d9f7c11831739c2a2f26','f77b5f1033391a7cacee3922670ebe894df3d627a6c76f68ed3b6290a54f1d19',6336,16,384,'','7dc4dd4e06efaab5d63ca9d7b11dde07aca398eeb446a815a6c3fd938e988940','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',204,0.026450872,7);
INSERT INTO "result" VALUES(5,1,1,'f48f1ee48dc5a03a3a7056dc2049f7e3f738c9a55fa6d9f7c11831739c2a2f26','c48b89a3ce2252aa624af77bca434716ad594aaaeed2c232b3175ede3ccabe61',6464,17,408,'','eb94e7da592ae56e1bd3ed12fb7e8189291d77519f9347085a47b6325072f7d5','152fd8e787c5740626902cb6956980d52840699635828f21c0fea88510e28083',207,0.018379463,8);
INSERT INTO "result" VALUES(6,1,0,'5644376b0f7af41343469175b260d4753adc882e256997254421e2608afcfc4e','9540f8c28d09453913ac674475dbd7bff7563e40ce694842b18da2310950e041',14400,88,8459485,'','3a76783a2eafc460dcb6a772f7ba5c9483ce05f1f127aa85083486ded53b8db4','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',1439,2.276623867,9);
INSERT INTO "result" VALUES(7,0,0,'5644376b0f7af41343469175b260d4753adc882e256997254421e2608afcfc4e','3d831beab1b65b61bc920a4676b139bea1ea76e4dc49a070f9b65c055f50cc2e',15520,98,9441094,'','625c9eb8f1beffa20b6dad84a94507ed8762413970a293d71265ab47ef1459cb','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',1466,2.293278541,10);
INSERT INTO "result" VALUES(8,0,1,'5644376b0f7af41343469175b260d4753adc882e256997254421e2608afcfc4e','20e06a25432d9bff3d2864c67afd5e793c4b8b6c97bddcc67a6324c256fd4e37',14848,92,8868727,'','8693f5897bae111dea39e49be4a9c7f0f5356dd4ba7157f5a7fa56b9c3bbb376','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',1459,1.913915042,11);
INSERT INTO "result" VALUES(9,1,1,'5644376b0f7af41343469175b260d4753adc882e256997254421e2608afcfc4e','28c5616223c8a0bd45796ebb68080eda80e1716226c767a07945731f3fac65a2',15296,96,9228562,'','7825d2421309824bc804199f61c5a6698458b53a3b321442dc7829ed80145804','bf18c23bd92be4bf5d47bc3db022ccbd92b6e8c02a88f662d59225e0251eeb63',1470,2.106048936,12);
CREATE TABLE task (
  id INTEGER PRIMARY KEY, key TEXT UNIQUE NOT NULL, manifest TEXT NOT NULL, i INTEGER NOT NULL, j INTEGER NOT NULL,
  settings TEXT NOT NULL, state INTEGER NOT NULL, failed_attempts INTEGER NOT NULL, result TEXT NOT NULL,
  size INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL, error TEXT NOT NULL, warnings TEXT NOT NULL DEFAULT '',
  bound REAL NOT NULL DEFAULT 0);
INSERT INTO "task" VALUES(1,'fed55f84faae14b16ad830500ef9a12662cbfe090714191c31064b5eb9a214cb','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',0,0,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.001953125}',1,0,'43e546bfdc12ba4882135447f6949a084d94a24f8a5c9a9f8bd02a13af3306be',6336,16,384,'','',0.0);
INSERT INTO "task" VALUES(2,'b1c019ac768aee07be751e899917bcda7d0dc731638ef7438b4ca5a3bdfadf8d','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',1,0,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.001953125}',1,0,'e55d8e38da493cda6f803b36e24d12f694c453dc15e89ff1807e9b81b8715f81',6336,16,384,'','',0.0);
INSERT INTO "task" VALUES(3,'a26bf2a65124962828a5cf956706f6d0093d3e4013e2de85faa1071395c3cee4','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',0,1,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.001953125}',1,0,'f77b5f1033391a7cacee3922670ebe894df3d627a6c76f68ed3b6290a54f1d19',6336,16,384,'','',0.0);
INSERT INTO "task" VALUES(4,'b3d67c6513264ee4a89adfdb0865cab5f7a8693f76744b24408cd7b5ad33ad36','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',1,1,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.001953125}',1,0,'6cfac20a79c199a31c7d9c76b493d98588685021b3a37e1d420da47703f6362d',6464,17,408,'','',0.0);
INSERT INTO "task" VALUES(5,'bd02f786234da982ebfce1dceedbfa4d48845e05504a3f75e6d4732d35e7610d','3ec33deac46f37c945005e0b8bd68e1243508ce3000d1ab642ba69667bf5b8b4',0,0,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.0625}',1,0,'43e546bfdc12ba4882135447f6949a084d94a24f8a5c9a9f8bd02a13af3306be',6336,16,384,'','',0.0);
INSERT INTO "task" VALUES(6,'ea693a6c12925dbdb51d5d8224c4cc6c1e53d5bc3231fa7aee9239935c6fcccc','3ec33deac46f37c945005e0b8bd68e1243508ce3000d1ab642ba69667bf5b8b4',1,0,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.0625}',1,0,'e55d8e38da493cda6f803b36e24d12f694c453dc15e89ff1807e9b81b8715f81',6336,16,384,'','',0.0);
INSERT INTO "task" VALUES(7,'9a85379d0b7fdaec69bfb7aca2a7076365260fcd5791057ed025cbbad5ec32c7','3ec33deac46f37c945005e0b8bd68e1243508ce3000d1ab642ba69667bf5b8b4',0,1,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.0625}',1,0,'f77b5f1033391a7cacee3922670ebe894df3d627a6c76f68ed3b6290a54f1d19',6336,16,384,'','',0.0);
INSERT INTO "task" VALUES(8,'6f7f8dea6106a64a58960376a16f454f6722efb57f4c6082680d10a4a5e6981a','3ec33deac46f37c945005e0b8bd68e1243508ce3000d1ab642ba69667bf5b8b4',1,1,'{"bounces":0,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":16.0,"rays":16,"reach":8.0,"tolerance":0.0625}',1,0,'c48b89a3ce2252aa624af77bca434716ad594aaaeed2c232b3175ede3ccabe61',6464,17,408,'','',0.0);
INSERT INTO "task" VALUES(9,'aa8398ba66278772ddff706aac540369ae69dbbbd78c5bdd991f7219f627e007','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',0,0,'{"bounces":8,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":1.0,"rays":65536,"reach":512.0,"tolerance":0.001953125}',1,0,'3d831beab1b65b61bc920a4676b139bea1ea76e4dc49a070f9b65c055f50cc2e',15520,98,9441094,'','',0.0);
INSERT INTO "task" VALUES(10,'dc74107992cef1b2864fe2d59850e3afc6dd4e21aea90f73cfc9a66959eaeb1d','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',1,0,'{"bounces":8,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":1.0,"rays":65536,"reach":512.0,"tolerance":0.001953125}',1,0,'9540f8c28d09453913ac674475dbd7bff7563e40ce694842b18da2310950e041',14400,88,8459485,'','',0.0);
INSERT INTO "task" VALUES(11,'6def09d666f9cee60bf9e82df56f95e25ad2bc75a86fe34eacc69464320a9e04','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',0,1,'{"bounces":8,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":1.0,"rays":65536,"reach":512.0,"tolerance":0.001953125}',1,0,'20e06a25432d9bff3d2864c67afd5e793c4b8b6c97bddcc67a6324c256fd4e37',14848,92,8868727,'','',0.0);
INSERT INTO "task" VALUES(12,'533cc9e3c9ed06fe2a2ace6c9bd3a412ef503ec081389aa1e0ef6ef3f091b744','38ee48362ce2ad33072524bfdf543bb41a0e1efd8fbae76f32ea47eb6aab63d4',1,1,'{"bounces":8,"error":0.0,"lprt":false,"lprt_bounces":2,"lprt_rays":1024,"min_distance":1.0,"rays":65536,"reach":512.0,"tolerance":0.001953125}',1,0,'28c5616223c8a0bd45796ebb68080eda80e1716226c767a07945731f3fac65a2',15296,96,9228562,'','',0.0);
CREATE INDEX result_of_sector ON result (i, j, settings_key, used);
CREATE INDEX result_by_use ON result (used);
CREATE INDEX result_of_file ON result (file);
CREATE INDEX result_of_footprint ON result (footprint);
CREATE INDEX result_of_inventory ON result (inventory);
COMMIT;
PRAGMA user_version=3;
